// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/voxel_grid.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "libscan/core/error.h"
#include "tests/search/clouds.h"

namespace scan {
namespace {

using Key = std::array<double, 3>;

Key key_of(const Eigen::Vector3d& point, const Eigen::Vector3d& low, double side_m) {
  const Eigen::Vector3d cube = ((point - low) / side_m).array().floor();
  return {cube.x(), cube.y(), cube.z()};
}

PointCloud bare_cloud(Points points) {
  PointCloud cloud;
  cloud.points = std::move(points);
  return cloud;
}

PointCloud full_cloud(Points points) {
  PointCloud cloud = bare_cloud(std::move(points));
  RandomStream random(3, 1, 4);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.normals.push_back(normal_vector(random).normalized());
    cloud.sigma_m.push_back(random.uniform());
    const Eigen::Vector3d a = normal_vector(random);
    cloud.covariances.push_back(a * a.transpose());
    cloud.intensity.push_back(100 * random.uniform());
  }
  return cloud;
}

// The whole contract, cube by cube, by a map of lists instead of running sums.
TEST(VoxelGrid, AveragesEachCubeInOrderOfItsFirstPoint) {
  const double side_m = 0.2;
  const PointCloud cloud = full_cloud(uniform_cloud(3000));
  const Eigen::Vector3d low = bounds_of(cloud.points).min();
  std::map<Key, std::vector<std::size_t>> cubes;
  std::vector<Key> order;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    auto& members = cubes[key_of(cloud.points[i], low, side_m)];
    if (members.empty()) order.push_back(key_of(cloud.points[i], low, side_m));
    members.push_back(i);
  }
  const PointCloud thinned = voxel_grid(cloud, side_m);
  ASSERT_EQ(thinned.size(), order.size());
  ASSERT_NO_THROW(check(thinned));
  // Means of at most 3000 terms of size at most 100: rounding stays below 3000 * 100 * 2^-53.
  const double tolerance = 3000 * 100 * 0x1p-53;
  for (std::size_t c = 0; c < order.size(); ++c) {
    PointCloud sum = full_cloud({Eigen::Vector3d::Zero()});
    sum.normals[0].setZero();
    sum.covariances[0].setZero();
    sum.sigma_m[0] = sum.intensity[0] = 0;
    const auto& members = cubes[order[c]];
    const auto count = static_cast<double>(members.size());
    for (const std::size_t i : members) {
      sum.points[0] += cloud.points[i] / count;
      sum.normals[0] += cloud.normals[i] / count;
      sum.covariances[0] += cloud.covariances[i] / count;
      sum.sigma_m[0] += cloud.sigma_m[i] / count;
      sum.intensity[0] += cloud.intensity[i] / count;
    }
    EXPECT_LT((thinned.points[c] - sum.points[0]).norm(), tolerance);
    EXPECT_LT((thinned.normals[c] * sum.normals[0].norm() - sum.normals[0]).norm(), tolerance);
    EXPECT_NEAR(thinned.normals[c].norm(), 1, tolerance);
    EXPECT_LT((thinned.covariances[c] - sum.covariances[0]).norm(), tolerance);
    EXPECT_NEAR(thinned.sigma_m[c], sum.sigma_m[0], tolerance);
    EXPECT_NEAR(thinned.intensity[c], sum.intensity[0], tolerance);
  }
}

TEST(VoxelGrid, KeepsEveryPointAloneInItsCube) {
  const PointCloud cloud = bare_cloud(lattice_cloud(9));
  const PointCloud thinned = voxel_grid(cloud, 0.5);
  EXPECT_EQ(thinned.points, cloud.points);
}

TEST(VoxelGrid, MergesAllIntoOneCubeThatHoldsAll) {
  const PointCloud thinned = voxel_grid(bare_cloud(lattice_cloud(5)), 100);
  ASSERT_EQ(thinned.size(), 1u);
  EXPECT_EQ(thinned.points[0], Eigen::Vector3d(2, 2, 2));  // sums of small integers are exact
}

TEST(VoxelGrid, ThinsFarFromZeroAsAtZero) {
  // The coordinates are multiples of 2^-19, as doubles at 2^33 are: moving them rounds nothing. A
  // plain sum of 2500 of them there would: it steps by 2^-8.
  Points points = uniform_cloud(20000);
  for (auto& point : points) point = (point * 0x1p19).array().round() * 0x1p-19;
  const Eigen::Vector3d offset = Eigen::Vector3d(1, 1, 1) * 0x1p33;
  const PointCloud here = voxel_grid(bare_cloud(points), 0.5);
  const PointCloud there = voxel_grid(bare_cloud(moved(points, 1, offset)), 0.5);
  ASSERT_EQ(here.size(), there.size());
  // Half a step of 2^-19 is lost when the offset is added again, and no more than half of that in
  // the difference below.
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_LT((there.points[i] - offset - here.points[i]).cwiseAbs().maxCoeff(), 0x1.8p-20);
}

TEST(VoxelGrid, TellsCubesApartBeyond32Bits) {
  // 2^40 cubes along each axis: keys cut to 32 bits, or packed into 64, would merge these.
  Points points = {{0, 0, 0}};
  for (const int axis : {0, 1, 2})
    for (const double far : {0x1p21, 0x1p32, 0x1p40})
      points.push_back(far * Eigen::Vector3d::Unit(axis));
  EXPECT_EQ(voxel_grid(bare_cloud(points), 1).size(), points.size());
}

TEST(VoxelGrid, LeavesOutPointsThatAreNotFinite) {
  const PointCloud cloud = bare_cloud(with_holes(uniform_cloud(100)));
  const PointCloud thinned = voxel_grid(cloud, 1e-6);
  EXPECT_EQ(thinned.size(), finite_points(cloud).size());
  for (const auto& point : thinned.points) EXPECT_TRUE(point.allFinite());
}

TEST(VoxelGrid, LeavesUnknownNormalsUnknown) {
  PointCloud cloud = bare_cloud(Points(2, {0, 0, 0}));
  cloud.normals = {{0, 0, 1}, {0, 0, -1}};
  EXPECT_EQ(voxel_grid(cloud, 1).normals[0], Eigen::Vector3d(0, 0, 0));
}

TEST(VoxelGrid, RefusesASideThatCannotBe) {
  const PointCloud cloud = bare_cloud(uniform_cloud(10));
  for (const double side : {0.0, -1.0, std::nan(""), 1e-300}) {
    try {
      voxel_grid(cloud, side);
      ADD_FAILURE() << "accepted the side " << side;
    } catch (const Error& error) {
      EXPECT_EQ(error.trouble(), Trouble::usage);
    }
  }
  EXPECT_TRUE(voxel_grid(PointCloud{}, 1).empty());
}

}  // namespace
}  // namespace scan
