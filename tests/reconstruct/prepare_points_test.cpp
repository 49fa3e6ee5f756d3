// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/prepare_points.h"

#include <gtest/gtest.h>

#include <limits>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

Eigen::Vector3d random_in_cube(RandomStream& random, double half) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return 2 * half * Eigen::Vector3d(x - 0.5, y - 0.5, z - 0.5);
}

PointCloud with_strays(PointCloud cloud, std::size_t count) {
  RandomStream random(8, 0, 0);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.push_back(random_in_cube(random, 1.3));
    cloud.normals.push_back(random_in_cube(random, 1).normalized());
  }
  return cloud;
}

TEST(PreparePoints, LeavesGoodPointsAsTheyAre) {
  const PointCloud cloud = sphere_cloud(5000);
  const PreparedPoints prepared = prepare_points(cloud, {});
  // Random samples: few have neighbours that reach twice as far as theirs.
  EXPECT_LE(prepared.outlying_points, 5u);
  EXPECT_EQ(prepared.turned_normals, 0u);
  EXPECT_EQ(prepared.estimated_normals, 0u);
}

TEST(PreparePoints, FindsStrays) {
  const PreparedPoints prepared = prepare_points(with_strays(sphere_cloud(20000), 4000), {});
  // Spacing is 0.025: a stray within two spacings may pass as noise. That shell has 4 pi x 0.1 of
  // the cube's 2.6^3, 7 % of the strays.
  std::size_t far = 0, good = 0;
  for (const auto& x : prepared.cloud.points) {
    far += std::abs(x.norm() - 1) > 0.05;
    good += std::abs(x.norm() - 1) < 1e-12;
  }
  EXPECT_LE(far, 20u);  // 0.5 % of the strays: some few lie flat by chance
  EXPECT_GE(good, 19900u);
  EXPECT_EQ(prepared.cloud.size() + prepared.outlying_points, 24000u);
}

// Thinned by 200 along x: reaches differ by 14, but each neighbourhood is flat.
TEST(PreparePoints, KeepsAThinlySampledSide) {
  const PointCloud all = sphere_cloud(40000);
  RandomStream random(3, 0, 0);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (random.uniform() < std::pow(200.0, -(all.points[i][0] + 1) / 2)) kept.push_back(i);
  const PreparedPoints prepared = prepare_points(subset(all, kept), {});
  EXPECT_LE(prepared.outlying_points, kept.size() / 100);
}

TEST(PreparePoints, EstimatesMissingNormals) {
  PointCloud cloud = sphere_cloud(5000);
  const std::vector<Eigen::Vector3d> truth = cloud.normals;
  for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.normals[i].setZero();
  cloud.normals[1] *= 7;
  const PreparedPoints prepared = prepare_points(cloud, {});
  ASSERT_EQ(prepared.outlying_points, 0u);
  EXPECT_EQ(prepared.estimated_normals, 1667u);
  // 16 neighbours reach 4 / sqrt(5000 / (4 pi)) / 2 = 0.1: their plane tilts by less than that.
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_GT(prepared.cloud.normals[i].dot(truth[i]), std::cos(0.1));
  cloud.normals.clear();
  EXPECT_EQ(prepare_points(cloud, {}).estimated_normals, 5000u);
}

TEST(PreparePoints, TakesSidesFromTheScanners) {
  PointCloud cloud = sphere_cloud(2000);
  std::vector<Eigen::Vector3d> inside(cloud.size(), Eigen::Vector3d::Zero());
  cloud.normals.clear();
  const PreparedPoints prepared = prepare_points(cloud, inside);
  for (std::size_t i = 0; i < prepared.cloud.size(); ++i)
    EXPECT_LT(prepared.cloud.normals[i].dot(prepared.cloud.points[i]), 0);
  EXPECT_EQ(prepared.viewpoints.size(), prepared.cloud.size());
}

TEST(PreparePoints, CountsWhatIsNotFinite) {
  PointCloud cloud = sphere_cloud(100);
  cloud.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  cloud.normals[5][1] = std::numeric_limits<double>::infinity();
  const PreparedPoints prepared = prepare_points(cloud, {});
  EXPECT_EQ(prepared.invalid_points, 1u);
  EXPECT_EQ(prepared.estimated_normals, 1u);
  cloud.points.assign(100, Eigen::Vector3d::Constant(std::nan("")));
  EXPECT_THROW(prepare_points(cloud, {}), Error);
}

TEST(PreparePoints, GivesTheSameForAnyNumberOfThreads) {
  PointCloud cloud = with_strays(torus_cloud(4000), 800);
  for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.normals[i] = -cloud.normals[i];
  const PreparedPoints many = prepare_points(cloud, {});
  const ThreadLimit one(1);
  const PreparedPoints single = prepare_points(cloud, {});
  EXPECT_EQ(single.cloud.points, many.cloud.points);
  EXPECT_EQ(single.cloud.normals, many.cloud.normals);
}

}  // namespace
}  // namespace scan
