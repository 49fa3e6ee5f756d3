// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/polar_balls.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// Random balls hold none of the points, are touched by one, and are not too small.
TEST(PolarBalls, AreEmptyAndTouchThePoints) {
  const PointCloud ring = torus_cloud(800);
  const std::vector<double> spacing(ring.size(), 0.13);
  const PolarBalls polar = polar_balls(ring.points, spacing, 0.2);
  ASSERT_GT(polar.balls.size(), 100u);
  for (std::size_t b = 0; b < polar.balls.size(); ++b) {
    const Ball& ball = polar.balls[b];
    double nearest = 1e9;
    for (const auto& x : ring.points) nearest = std::min(nearest, (x - ball.centre).norm());
    EXPECT_NEAR(nearest, ball.radius, 1e-9 * (1 + ball.radius));
    EXPECT_NEAR((polar.touched[b] - ball.centre).norm(), ball.radius, 1e-9 * (1 + ball.radius));
    if (!polar.is_outer[b]) {
      EXPECT_GT(ball.radius, 0.2);
    }
  }
}

TEST(PolarBalls, OfASphereAreOneInside) {
  const PointCloud sphere = sphere_cloud(1000);
  const PolarBalls polar = polar_balls(sphere.points, std::vector<double>(1000, 0.11), 0);
  std::size_t inner = 0;
  for (std::size_t b = 0; b < polar.balls.size(); ++b) {
    if (polar.is_outer[b]) continue;
    ++inner;
    EXPECT_LT(polar.balls[b].centre.norm(), 1e-9);
    EXPECT_NEAR(polar.balls[b].radius, 1, 1e-9);
  }
  EXPECT_EQ(inner, 1u);
  EXPECT_GE(polar.opposites.size(), 1000u);
}

}  // namespace
}  // namespace scan
