// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ray_bricks.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scan {
namespace {

constexpr int depth = 4;  // 16 cells
const Eigen::Vector3d middle(0.5, 0.5, 0.5);

// Parallel to z from above, four times four through each cell.
RayBricks shower() {
  RayBricks bricks(std::span(&middle, 1), depth);
  for (int i = 0; i < 64 * 64; ++i) {
    const double x = (i % 64 + 0.5) / 64, y = (i / 64 + 0.5) / 64;
    bricks.count({x, y, 0.9}, {x, y, 0.1});
  }
  return bricks;
}

// Each ray counts once in each layer of corners.
TEST(RayBricks, TellHowManyPassThroughACell) {
  const RayBricks bricks = shower();
  EXPECT_EQ(bricks.cell_area(), 1.0 / 256);
  EXPECT_DOUBLE_EQ(bricks.rays_through(middle, Eigen::Vector3d::UnitZ()), 16);
  EXPECT_DOUBLE_EQ(bricks.rays_through(middle, -Eigen::Vector3d::UnitZ()), -16);
  EXPECT_DOUBLE_EQ(bricks.rays_through(middle, {std::sqrt(0.75), 0, 0.5}), 8);
}

// Bricks reach a brick and a half from a place at most; where there are none nothing is counted.
TEST(RayBricks, KnowNothingFarFromThePlaces) {
  const RayBricks bricks = shower();
  EXPECT_EQ(bricks.rays_through({2, 2, 2}, Eigen::Vector3d::UnitZ()), 0);
  const Eigen::Vector3d corner = Eigen::Vector3d::Constant(1.0 / 64);
  RayBricks elsewhere(std::span(&corner, 1), 6);
  elsewhere.count({0.5, 0.5, 0.9}, {0.5, 0.5, 0.1});
  EXPECT_EQ(elsewhere.rays_through(middle, Eigen::Vector3d::UnitZ()), 0);
}

}  // namespace
}  // namespace scan
