// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What each figure is, in one line, to stand beside the number.
#pragma once

#include <string>

namespace scan {

// By the name of a Measurement; empty for a name that no function of verify gives. What it was
// taken over (sample, denominator) the Measurement says itself.
std::string definition(const std::string& name);

// For a name that has none: the nearest that has one ("did you mean 'accuracy_rms'?"), or empty.
std::string figure_hint(const std::string& name);

}  // namespace scan
