// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Finding one figure among measurements.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "libscan/verify/verdict.h"

namespace scan {

inline const Measurement& measurement(const std::vector<Measurement>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Measurement& m) { return m.name == name; });
  if (found == all.end()) throw std::out_of_range("not measured: " + name);
  return *found;
}

inline double figure(const std::vector<Measurement>& all, const std::string& name) {
  return measurement(all, name).value;
}

}  // namespace scan
