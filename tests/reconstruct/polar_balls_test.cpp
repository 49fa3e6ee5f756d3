// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/polar_balls.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

PolarTie tie(std::uint32_t first, std::uint32_t second, double certainty, bool is_same_side) {
  return {first, second, certainty, is_same_side};
}

TEST(LabelInside, CrossesTheSurfaceWithEachPairOfOpposites) {
  // 0 outer, 1 behind the surface, 2 beside 1, 3 behind the surface again, 4 tied to none.
  const std::vector<PolarTie> ties{tie(0, 1, 0.9, false), tie(2, 1, 0.5, true),
                                   tie(3, 2, 0.8, false)};
  EXPECT_EQ(label_inside(5, ties, std::vector<char>{1, 0, 0, 0, 0}),
            (std::vector<char>{0, 1, 1, 0, 0}));
}

// What is told twice goes to the surer: through 2 it is 0.9 x 0.9 inside, straight 0.3 outside.
TEST(LabelInside, BelievesTheSurest) {
  const std::vector<PolarTie> ties{tie(0, 1, 0.3, true), tie(0, 2, 0.9, false),
                                   tie(2, 1, 0.9, true)};
  EXPECT_EQ(label_inside(3, ties, std::vector<char>{1, 0, 0}), (std::vector<char>{0, 1, 1}));
}

// 1 hears "outside" at 0.50 and "inside", through 2, at 0.45: it waits for 3, less sure, which
// hears from nobody else, so that nothing that 1 says wrongly spreads to 3.
TEST(LabelInside, LeavesTheContradictedToTheEnd) {
  const std::vector<PolarTie> ties{tie(0, 1, 0.5, true), tie(0, 2, 0.9, false),
                                   tie(2, 1, 0.5, true), tie(1, 3, 1.0, true),
                                   tie(2, 3, 0.4, true)};
  EXPECT_EQ(label_inside(4, ties, std::vector<char>{1, 0, 0, 0}), (std::vector<char>{0, 0, 1, 1}));
}

// Outer 0 and its neighbour 1; behind scattered points 2, which is sure of 3; a void 4 inside them.
TEST(LabelInside, CrossesLayersOfPointsThatNoBallsShare) {
  const std::vector<PolarTie> ties{tie(0, 1, 0.9, true), tie(4, 3, 0, true), tie(2, 1, 0, true),
                                   tie(2, 3, 0.8, true)};
  EXPECT_EQ(label_inside(5, ties, std::vector<char>{1, 0, 0, 0, 0}),
            (std::vector<char>{0, 0, 1, 1, 0}));
}

// Unit spheres whose centres are d apart meet where their radii enclose an angle of cosine
// 1 - d^2 / 2.
TEST(SameSideCertainty, IsTheCosineBetweenRadii) {
  const auto of_distance = [](double d) {
    return same_side_certainty({{0, 0, 0}, 1}, {{d, 0, 0}, 1});
  };
  EXPECT_DOUBLE_EQ(of_distance(0), 1);
  EXPECT_DOUBLE_EQ(of_distance(1), 0.5);
  EXPECT_EQ(of_distance(1.5), 0);                                              // -0.125
  EXPECT_EQ(of_distance(3), 0);                                                // apart
  EXPECT_NEAR(same_side_certainty({{0, 0, 0}, 3}, {{5, 0, 0}, 4}), 0, 1e-15);  // 3, 4, 5
}

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
