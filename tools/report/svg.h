// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Plots as SVG text: the same bytes for the same numbers.
#pragma once

#include <string>
#include <vector>

#include "tools/report/deviation.h"

namespace scan {

// A line across the histogram at a value and at its negative.
struct HistogramLimit {
  std::string name;
  double value_m = 0;
};

// Signed deviations, coloured like the surface, with the share beyond the scale named and the
// limits that lie within it; axis in a readable unit.
std::string histogram_plot(const DeviationHistogram& histogram,
                           const std::vector<HistogramLimit>& limits);

// The legend of the diverging scale, horizontal.
std::string legend_plot(double limit_m);

// How much of a limit a value uses: a bar whose mark is the limit.
std::string limit_bar(double share_of_limit, bool pass);

}  // namespace scan
