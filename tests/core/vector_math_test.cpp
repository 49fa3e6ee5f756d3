// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/vector_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan {
namespace {

// The last step's y (1.5 - x y^2 / 2): x y^2 / 2 = 1/2 is rounded twice, the difference and the
// product once each, by 2^-24 of themselves at most.
TEST(VectorMath, InvertsSquareRoots) {
  for (float x = 1e-12F; x < 1e18F; x *= 1.0037F)
    ASSERT_NEAR(inverse_sqrt(x) * std::sqrt(static_cast<double>(x)), 1, 4 * 0x1p-24) << x;
  EXPECT_EQ(0 * inverse_sqrt(0.0F), 0);
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
