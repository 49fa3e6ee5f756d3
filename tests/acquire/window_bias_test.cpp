// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Windows on curved surfaces: the mean over them, and matches without it.
#include "libscan/acquire/window_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/acquire/stereo.h"
#include "tests/acquire/stereo_scene.h"

namespace scan::decoding {
namespace {

constexpr int half = 3, middle = 30;

template <class Disparity>
Image<float> map_of(Disparity&& disparity) {
  Image<float> map(61, 61);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      map(x, y) = static_cast<float>(disparity(x - middle, y - middle));
  return map;
}

// Of a quadric the mean over the window less the middle is the shift, whatever its slopes are.
// Floats of 20 round at 1e-6, second differences over 12 px at 4e-6 / 72.
TEST(WindowBias, IsTheMeanOverTheWindowLessTheMiddle) {
  const auto disparity = [](double x, double y) {
    return 20 + 0.05 * x - 0.08 * y - 0.004 * x * x + 0.001 * y * y + 0.003 * x * y;
  };
  double mean = 0;
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x) mean += disparity(x, y) / 49;
  const WindowShift shift = window_shift(map_of(disparity), middle, middle, half);
  EXPECT_NEAR(shift.shift_px, mean - disparity(0, 0), 1e-6);
  EXPECT_NEAR(shift.own_share, 4.0 * half * (half + 1) / (6 * 144), 1e-15);
}

TEST(WindowBias, OfAPlaneIsNone) {
  const Image<float> map = map_of([](double x, double y) { return 20 + 0.25 * x - 0.125 * y; });
  EXPECT_EQ(window_shift(map, middle, middle, half).shift_px, 0);
}

// Means over windows of a sampled wave, and the shift taken from them: the same by sums. To the
// map's single precision, 1e-6 of 20 px.
TEST(WindowBias, WavesAreLeftAsTheTransferSays) {
  for (const double period : {10.0, 16.0, 40.0}) {
    const double k = 2 * std::numbers::pi / period;
    const auto blurred = [&](double x, double) {
      double mean = 0;
      for (int i = -half; i <= half; ++i) mean += std::cos(k * (x + i)) / (2 * half + 1);
      return 20 + 0.2 * mean;
    };
    const double left =
        blurred(0, 0) - window_shift(map_of(blurred), middle, middle, half).shift_px;
    EXPECT_NEAR((left - 20) / 0.2, window_transfer(period, half), 2e-5) << period;
  }
}

// A hole to the left, a step below: neither axis is known. At the image's edge the other one is.
TEST(WindowBias, CountsNothingWhereTheSurfaceEnds) {
  const auto bowl = [](double x, double y) { return 20 + 0.004 * (x * x + y * y); };
  Image<float> map = map_of(bowl);
  map(middle - 4 * half, middle) = std::numeric_limits<float>::quiet_NaN();
  map(middle, middle + 4 * half) += 7;
  EXPECT_EQ(window_shift(map, middle, middle, half).shift_px, 0);
  EXPECT_EQ(window_shift(map, middle, middle, half).own_share, 0);
  EXPECT_NEAR(window_shift(map_of(bowl), 2, middle, half).shift_px, 0.004 * 4, 1e-6);
}

// Windows of 7 px lie 2 (d_xx + d_yy) = 0.032 px off this bowl. What the texture makes of it
// differs from window to window: waves of 7 px and more fill a window with some six patches of
// gradient, whose mean square distances from the middle average to 1 +- 0.4. Over some 290 windows
// beside each other that is 0.032 * 0.4 / 17 = 0.0008 px; rounding, 0.003 px a window, is less. And
// waves much longer than the window weigh its places by the square of their distance along the
// wave, since the free brightness takes their mean gradient: there the mean of x^2 is sum x^4 / sum
// x^2 = 7 instead of 4, the shift (7 + 4) / 8 = 1.4 times as large. So 0 to 0.4 of it is left.
TEST(WindowBias, IsTakenAwayFromMatches) {
  const test::Disparity bowl = [](double x, double y) {
    return 20 + 0.004 * ((x - 140) * (x - 140) + (y - 60) * (y - 60));
  };
  double sum = 0, count = 0;
  for (const std::uint64_t seed : {5, 6, 7, 8}) {
    const DisparityMap map = match(test::render(test::Texture(seed), bowl, 240, 120, 64, 0));
    for (int y = 30; y < 90; ++y)
      for (int x = 110; x < 170; ++x) {
        if (std::isnan(map.disparity_px(x, y))) continue;
        sum += map.disparity_px(x, y) - bowl(x, y);
        ++count;
      }
  }
  EXPECT_GT(count, 14000);
  EXPECT_GT(sum / count, -4 * 0.0008);
  EXPECT_LT(sum / count, 0.4 * 0.032);
}

}  // namespace
}  // namespace scan::decoding
