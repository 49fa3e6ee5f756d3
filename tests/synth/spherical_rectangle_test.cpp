// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/spherical_rectangle.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scan::synth {
namespace {

// A pyramid's solid angle 4 asin(a b / sqrt((a^2 + 4 h^2) (b^2 + 4 h^2))) for sides a, b at height
// h. Rounding of four angles near pi / 2, and of the truth, whose asin has the slope 1 / sqrt(1 -
// s^2).
TEST(SphericalRectangle, SolidAngleOfAPyramid) {
  for (const double h : {0.01, 0.3, 2.0, 30.0}) {
    const double a = 0.8, b = 0.5;
    const double s = a * b / std::sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h));
    EXPECT_NEAR(SphericalRectangle({a / 2, b / 2}, {0, 0, h}).solid_angle_sr, 4 * std::asin(s),
                4e-15 + 8e-16 / std::sqrt(1 - s * s));
  }
}

}  // namespace
}  // namespace scan::synth
