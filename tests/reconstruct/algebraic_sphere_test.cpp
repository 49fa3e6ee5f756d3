// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/algebraic_sphere.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

TEST(AlgebraicSphere, FitsASphereExactly) {
  SphereSums sums;
  RandomStream random(1, 0, 0);
  const Eigen::Vector3d shift(0.2, -0.1, 0.9);
  const PointCloud cloud = sphere_cloud(50, 0.7);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.points[i][2] > 0.3)
      sums.add(0.1 + random.uniform(), cloud.points[i] - shift, cloud.normals[i]);
  const auto sphere = sums.fit();
  ASSERT_TRUE(sphere);
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.3, 0.2, 0.1), Eigen::Vector3d(2, 0, 0)})
    EXPECT_NEAR(sphere->distance(x - shift), x.norm() - 0.7, 1e-12);
}

TEST(AlgebraicSphere, FitsAPlaneExactly) {
  SphereSums sums;
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 2) / 3;
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  for (int i = 0; i < 9; ++i) sums.add(1 + i, 0.1 * normal + i % 3 * u + i / 3 * v, normal);
  const auto plane = sums.fit();
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->square, 0, 1e-14);
  EXPECT_NEAR(plane->distance(Eigen::Vector3d(0.4, -3, 1)),
              normal.dot(Eigen::Vector3d(0.4, -3, 1)) - 0.1, 1e-12);
}

TEST(AlgebraicSphere, TellsNormalsThatCancel) {
  SphereSums sums;
  EXPECT_FALSE(sums.fit());
  sums.add(1, {0, 0, 0}, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(sums.agreement(), 1);
  sums.add(1, {0, 0, 1}, -Eigen::Vector3d::UnitZ());
  EXPECT_EQ(sums.agreement(), 0);
}

// x^2 + y^2 + z^2 - 1 over (2, 0, 0) once and (0, 0, 1) twice: (3 + 0 + 0) / 3.
TEST(AlgebraicSphere, HasAMeanOverPoints) {
  const AlgebraicSphere sphere{-1, Eigen::Vector3d::Zero(), 1};
  SphereSums points;
  points.add(1, {2, 0, 0}, Eigen::Vector3d::UnitX());
  points.add(2, {0, 0, 1}, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(sphere.mean_value(points), 1, 1e-15);
}

// All round a closed surface normals cancel, and there is a sphere all the same. A cube's corners,
// normals along them: the sphere through the corners, gradient 1 there.
TEST(AlgebraicSphere, FitsAClosedSurface) {
  SphereSums sums;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d x(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    sums.add(1, x, x.normalized());
  }
  EXPECT_NEAR(sums.agreement(), 0, 1e-15);
  const auto sphere = sums.fit();
  ASSERT_TRUE(sphere);
  EXPECT_NEAR(sphere->gradient_on_sphere(), 1, 1e-14);
  EXPECT_NEAR(sphere->distance(Eigen::Vector3d(3, 0, 0)), 3 - std::sqrt(3), 1e-14);
}

}  // namespace
}  // namespace scan
