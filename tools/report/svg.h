// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Plots as SVG text: the same bytes for the same numbers.
#pragma once

#include <Eigen/Core>
#include <span>
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

// Where the numbers of places on a square picture stand, pixels: discs of badge_radius_px, each
// beside its place, away from the picture's middle, or turned by eighths of a circle so that it
// covers none of those before it, if there is such room. The picture holds them whole.
inline constexpr double badge_radius_px = 9.5;
std::vector<Eigen::Vector2d> badge_places(std::span<const Eigen::Vector2d> places_px,
                                          double picture_px);

}  // namespace scan
