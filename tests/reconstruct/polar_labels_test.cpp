// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/polar_labels.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace scan
