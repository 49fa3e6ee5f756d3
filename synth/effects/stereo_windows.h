// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Windows of a stereo pair's images as its matcher compares them, before noise.
//
// The matcher fits the shift between two windows by least squares: a change e_i of the difference
// of the images moves it by sum(g e) / sum(g^2) with the slope g along the row (Lucas and Kanade
// 1981), both less their means, since it fits the images' difference in brightness as well; by
// Cauchy and Schwarz that is at most sqrt(sum e^2 / sum g^2).
#pragma once

#include <array>

#include "synth/ray_caster.h"
#include "synth/scanners/stereo_pair.h"

namespace scan::synth {

// Of the refinement's 7 x 7 pixels (libscan/acquire/disparity_refinement.cpp at blocks of 5), with
// the columns besides that cubic convolution needs: two to the right, one to the left.
struct StereoWindow {
  static constexpr int half_px = 3, side_px = 2 * half_px + 1;
  static constexpr double pixels = side_px * side_px;

  std::array<std::array<double, side_px + 3>, side_px> electrons{};

  double at(int row, int column) const { return electrons[row][column + 1]; }  // 0 .. side_px - 1
  double slope(int row, int column) const {
    return (at(row, column + 1) - at(row, column - 1)) / 2;
  }
  double centre() const { return at(half_px, half_px); }
};

// Mean electrons about a pixel.
StereoWindow window_at(const StereoPair& scanner, const RayCaster& caster,
                       const Pose& world_from_scanner, StereoSide side, int column, int row);

double slope_energy(const StereoWindow& window);
// Of the slopes less their mean: what is left of a slope if the brightness may change.
double varying_slope_energy(const StereoWindow& window);
// The window's slope down the columns over that along the rows: what a shift by a row costs.
double slope_ratio(const StereoWindow& window);

// Both images' windows; the right one lies `between` its column and the next.
struct WindowPair {
  StereoWindow left, right;
  double between = 0;
};
// The largest shift by what an effect changes in the left window but not in the right one, if that
// followed the slope everywhere (Cauchy and Schwarz).
double change_px(const WindowPair& with, const WindowPair& without);

}  // namespace scan::synth
