// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/prepare_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

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

// A tube 2.25 spacings in radius beside a sphere sampled four times as finely. The 16 nearest reach
// 2.26 spacings, once round by 1 rad each way: no plane, but all turned by less than 60 degrees. So
// all agree; planes through so few may be off by enough for 1 %.
TEST(PreparePoints, KeepsAThinlySampledTube) {
  constexpr double spacing_m = 1.0 / 30, radius_m = 2.25 * spacing_m;
  const double area_m2 = 4 * std::numbers::pi * std::numbers::pi * radius_m;
  const auto of_tube = static_cast<std::size_t>(area_m2 / (spacing_m * spacing_m));
  PointCloud cloud{.points = torus_cloud(of_tube, 1, radius_m).points};
  for (const auto& x : sphere_cloud(45000, 0.5).points) cloud.points.push_back(x);
  const std::vector<Eigen::Vector3d> left = prepare_points(cloud, {}).cloud.points;
  const auto kept = std::count_if(left.begin(), left.end(),
                                  [](const Eigen::Vector3d& x) { return x.norm() > 0.7; });
  EXPECT_GE(kept, 0.99 * static_cast<double>(of_tube));
}

// A tube of six of the sphere's spacings in radius on its pole, whose rings grow apart from one
// spacing to 2.7: fewer than 1 % of the points lie thinly, but one step leads to the next.
TEST(PreparePoints, KeepsAThinBendThatHangsTogetherWithTheBody) {
  PointCloud cloud{.points = sphere_cloud(40000, 0.5).points};
  const double least_m = std::sqrt(std::numbers::pi / 40000), radius_m = 6 * least_m;
  double z = 0.5, step_m = least_m;
  std::size_t thin = 0;
  for (int ring = 0; z < 0.5 + 60 * least_m; ++ring, z += step_m) {
    step_m = std::min(2.7 * least_m, 1.08 * step_m);
    const double count = std::round(2 * std::numbers::pi * radius_m / step_m);
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5 * (ring % 2)) / count;
      cloud.points.push_back({radius_m * std::cos(angle), radius_m * std::sin(angle), z});
      thin += step_m > 2.2 * least_m;
    }
  }
  ASSERT_LT(thin, cloud.size() / 100);
  ASSERT_GT(thin, 100u);
  // Of the last ring the neighbours lie all on one side: they may reach too far for points alone.
  EXPECT_LE(prepare_points(cloud, {}).outlying_points, 20u);
}

// Points enough for all to be neighbours, on a sheet that touches nothing: 0.2 % of all.
TEST(PreparePoints, LeavesOutAnIsland) {
  for (const double bend : {0.0, 2.0}) {
    PointCloud cloud{.points = sphere_cloud(20000, 0.5).points};
    for (int i = 0; i < 40; ++i) {
      const double u = 0.06 * (i % 8) - 0.21, v = 0.06 * (i / 8) - 0.12;
      cloud.points.push_back({u, v, 1.5 + bend * (u * u + v * v)});
    }
    const std::vector<Eigen::Vector3d> left = prepare_points(cloud, {}).cloud.points;
    EXPECT_EQ(
        std::count_if(left.begin(), left.end(), [](const Eigen::Vector3d& x) { return x[2] > 1; }),
        0)
        << bend;
  }
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
