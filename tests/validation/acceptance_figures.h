// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A figure of a list by its name, and the paint of the bodies.
#pragma once

#include <cmath>

#include "libscan/verify/artefacts.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {

inline double value(const std::vector<Measurement>& figures, const std::string& name) {
  for (const Measurement& m : figures)
    if (m.name == name) return m.value;
  ADD_FAILURE() << name;
  return NAN;
}

inline const Material grey{.name = "grey", .bsdf = Lambert{0.5}, .texture = {}};

}  // namespace scan::synth
