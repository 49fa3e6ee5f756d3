// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/stereo_windows.h"

#include "tests/synth/stereo_images.h"

namespace scan::synth {
namespace {

// Electrons a row + b column + c column^2 about the window's centre.
StereoWindow window_of(double a, double b, double c) {
  StereoWindow w;
  for (int row = 0; row < StereoWindow::side_px; ++row)
    for (int i = 0; i < StereoWindow::side_px + 3; ++i) {
      const double x = i - 1 - StereoWindow::half_px;
      w.electrons[row][i] = a * (row - StereoWindow::half_px) + b * x + c * x * x;
    }
  return w;
}

// Slopes b + 2 c x at x = -3 .. 3: squares b^2 + 4 c^2 x^2, sum x^2 = 28 in each of seven rows.
TEST(StereoWindow, KnowsTheSlopesOfAParabola) {
  const StereoWindow w = window_of(2, 5, 0.5);
  EXPECT_NEAR(slope_energy(w), 49 * 25 + 7 * 28, 1e-9);
  EXPECT_NEAR(varying_slope_energy(w), 7 * 28, 1e-9);
  EXPECT_NEAR(slope_ratio(window_of(2, 5, 0)), 2.0 / 5 * std::sqrt(6.0 / 7), 1e-12);
}

// Cubic convolution is exact for parabolas: 0.25 px between two columns are no change.
TEST(StereoWindow, ReadsBetweenColumns) {
  const StereoWindow left = window_of(2, 5, 0.5);
  StereoWindow right = left;
  for (auto& row : right.electrons)
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double x = static_cast<double>(i) - 1 - StereoWindow::half_px - 0.25;
      row[i] += 5 * -0.25 + 0.5 * (x * x - (x + 0.25) * (x + 0.25));
    }
  const WindowPair still{window_of(0, 0, 1), window_of(0, 0, 1), 0};
  EXPECT_NEAR(change_px({left, right, 0.25}, {still.left, still.right, 0}), 0, 1e-12);
}

// The right camera turned by 0.1 px: a change that follows the slope everywhere, so that Cauchy and
// Schwarz's bound is the shift itself; the slopes change by some per cent over 0.1 px of waves of
// 20 px.
TEST(StereoWindow, TellsAShift) {
  StereoPair turned = small_pair();
  turned.right_rotation_error_rad = {0, 1e-3, 0};
  turned.sub_rays = 1;
  const RayCaster caster({.objects = {plane_at(1)}, .materials = {noisy(0.1, 1)}});
  const auto windows = [&](const StereoPair& pair) {
    const auto at = [&](StereoSide side, int column) {
      return window_at(pair, caster, Pose::Identity(), side, column, 16);
    };
    return WindowPair{at(StereoSide::left, 35), at(StereoSide::right, 25), 0};
  };
  StereoPair straight = turned;
  straight.right_rotation_error_rad.setZero();
  EXPECT_NEAR(change_px(windows(straight), windows(straight)), 0, 1e-12);
  EXPECT_NEAR(change_px(windows(turned), windows(straight)), 0.1, 0.01);
}

}  // namespace
}  // namespace scan::synth
