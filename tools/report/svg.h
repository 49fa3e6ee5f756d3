// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Plots as SVG text: the same bytes for the same numbers.
#pragma once

#include <string>
#include <vector>

namespace scan {

// Histogram of signed deviations in metres over [-limit_m, limit_m], coloured like the surface,
// with the share of values outside the limits named; axes in a readable unit.
std::string deviation_histogram(const std::vector<double>& deviations_m, double limit_m);

// The legend of the diverging scale, horizontal.
std::string deviation_legend(double limit_m);

}  // namespace scan
