// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/vector_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan {
namespace {

TEST(VectorMath, InvertsSquareRoots) {
  for (double x = 1e-12; x < 1e18; x *= 1.0037)
    ASSERT_NEAR(inverse_sqrt(x) * std::sqrt(x), 1, 4e-11) << x;
}

// The rest of the series is below 2 s^15 / 15 / (1 - s^2), |s| <= 0.1716: 4.51e-13; sums of up to
// 42 are rounded.
TEST(VectorMath, TakesLogarithms) {
  for (double x = 0.5; x < 0x1p60; x *= 1.00013)
    ASSERT_NEAR(logarithm(x), std::log(x), 4.52e-13 + 1e-14 * std::abs(std::log(x))) << x;
}

// Next terms at pi / 4: x^14 / 14! = 3.9e-13 of the cosine, x^15 / 15! of the sine.
TEST(VectorMath, TurnsByAnyAngle) {
  for (double turns = -7.3; turns < 9.1; turns += 1.0 / 10007) {
    const Turned angle = turned(turns);
    ASSERT_NEAR(angle.cosine, std::cos(2 * std::numbers::pi * turns), 4.2e-13) << turns;
    ASSERT_NEAR(angle.sine, std::sin(2 * std::numbers::pi * turns), 4.2e-13) << turns;
  }
}

// A number of turns far from 0 is a sum of a whole number, that does not count, and the rest.
TEST(VectorMath, DropsWholeTurns) {
  for (const double whole : {1e3, 1e6, 0x1p40, -0x1p40})
    for (double rest = 0; rest < 1; rest += 1.0 / 512) {
      const Turned near = turned(rest), far = turned(whole + rest);
      ASSERT_NEAR(far.cosine, near.cosine, 1e-15) << whole << " + " << rest;
      ASSERT_NEAR(far.sine, near.sine, 1e-15) << whole << " + " << rest;
    }
}

}  // namespace
}  // namespace scan
