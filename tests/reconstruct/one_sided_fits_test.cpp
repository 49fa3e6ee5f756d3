// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/one_sided_fits.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/solids.h"

namespace scan {
namespace {

struct Fits {
  PointCloud cloud;
  std::vector<double> spacing;
  OneSidedFits fits;
  explicit Fits(PointCloud from, double spacing_m)
      : cloud(std::move(from)),
        spacing(cloud.size(), spacing_m),
        fits(cloud.points, cloud.normals, spacing) {}
};

// Planes are quadrics: what is left is rounding.
constexpr double rounding = 1e-9;

// 6 faces of a square metre with 12,000 samples: 0.0224 m apart.
TEST(OneSidedFits, MeetAtACubesEdgeAndCorner) {
  const Fits cube(cube_cloud(12000), 0.0224);
  const Eigen::Vector3d near_edge(0.49, 0.48, 0.1);
  const SharpSurface edge = cube.fits.about(near_edge);
  ASSERT_EQ(edge.count, 2);
  EXPECT_TRUE(edge.first_two_intersect);
  EXPECT_LT(
      (edge.meeting_place(std::array{0, 1}, near_edge) - Eigen::Vector3d(0.5, 0.5, 0.1)).norm(),
      rounding);
  EXPECT_NEAR(edge.at({0.6, 0.4, 0.1}).distance, 0.1, rounding);
  EXPECT_NEAR(edge.at({0.48, 0.4, 0.1}).distance, -0.02, rounding);
  const Eigen::Vector3d near_corner(0.49, -0.48, 0.51);
  const SharpSurface corner = cube.fits.about(near_corner);
  ASSERT_EQ(corner.count, 3);
  EXPECT_LT(
      (corner.meeting_place(std::array{0, 1, 2}, near_corner) - Eigen::Vector3d(0.5, -0.5, 0.5))
          .norm(),
      rounding);
  EXPECT_NEAR(corner.at({0.4, -0.4, 0.52}).distance, 0.02, rounding);
}

// An L of cubes: its inner edge is concave, and where that edge ends, one convex and two concave
// edges, or two convex and one concave, meet.
TEST(OneSidedFits, TellConcaveEdgesAndSaddles) {
  const Fits step(step_cloud(30000), 0.0224);
  const SharpSurface concave = step.fits.about({0.01, 0.2, 0.01});
  ASSERT_EQ(concave.count, 2);
  EXPECT_FALSE(concave.first_two_intersect);
  const Eigen::Vector3d end(0, 0.5, 0);
  const SharpSurface saddle = step.fits.about(end);
  ASSERT_EQ(saddle.count, 3);
  EXPECT_FALSE(saddle.first_two_intersect);
  EXPECT_TRUE(saddle.third_intersects);
  EXPECT_LT((saddle.meeting_place(std::array{0, 1, 2}, {0.01, 0.49, 0.01}) - end).norm(), rounding);
  // Inside the solid, above the step, beyond the side.
  EXPECT_LT(saddle.at({-0.02, 0.48, -0.02}).distance, 0);
  EXPECT_LT(saddle.at({-0.02, 0.48, 0.02}).distance, 0);
  EXPECT_GT(saddle.at({0.02, 0.48, 0.02}).distance, 0);
  EXPECT_GT(saddle.at({-0.02, 0.52, -0.02}).distance, 0);
}

TEST(OneSidedFits, SeeNoFeatureOnSmoothSurfaces) {
  const Fits sphere(sphere_cloud(3000), 0.0647);
  RandomStream random(2, 0, 0);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d x = sphere.cloud.points[static_cast<std::size_t>(30 * i)];
    EXPECT_EQ(sphere.fits.about(x).count, 0);
  }
}

// The rim of a can: one piece is a cylinder of radius 0.5, which a quadric over reach r = 0.08
// leaves by the fourth order, r^4 / (8 R^3) = 4e-5.
TEST(OneSidedFits, FollowsACurvedRim) {
  const Fits can(can_cloud(12000), 0.0198);
  const SharpSurface rim = can.fits.about({0.49, 0.01, 0.49});
  ASSERT_EQ(rim.count, 2);
  const Eigen::Vector3d at = rim.meeting_place(std::array{0, 1}, {0.49, 0.01, 0.49});
  EXPECT_NEAR(at.head<2>().norm(), 0.5, 4e-5);
  EXPECT_NEAR(at[2], 0.5, rounding);
}

}  // namespace
}  // namespace scan
