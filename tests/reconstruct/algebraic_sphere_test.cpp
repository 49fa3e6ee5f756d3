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

TEST(AlgebraicSphere, RefusesNormalsThatCancel) {
  SphereSums sums;
  EXPECT_FALSE(sums.fit());
  sums.add(1, {0, 0, 0}, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(sums.fit());
  sums.add(1, {0, 0, 1}, -Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(sums.fit());
}

}  // namespace
}  // namespace scan
