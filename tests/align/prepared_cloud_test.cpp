// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/prepared_cloud.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

TEST(PreparedCloud, PosesGoThereAndBack) {
  RandomStream random(1, 0, 0);
  const PointCloud a = test::bumpy_surface(100, 1),
                   b = transformed(test::random_pose(random, 1, 5), a);
  const PreparedCloud source = prepare(a), target = prepare(b);
  const Pose pose = test::random_pose(random, 2, 3);
  const Pose local = local_pose(pose, source, target);
  EXPECT_LT((global_pose(local, source, target).matrix() - pose.matrix()).norm(), 1e-14);
  // The same point either way.
  const Vector3d& given = a.points[source.index[7]];
  EXPECT_LT((local * source.points[7] + target.origin - pose * given).norm(), 1e-14);
}

TEST(PreparedCloud, HoldsEveryFinitePointOnce) {
  PointCloud cloud = test::bumpy_surface(100, 1);
  cloud.points[3].y() = std::nan("");
  cloud.normals[5].x() = INFINITY;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.covariances.push_back(double(i) * Eigen::Matrix3d::Identity());
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_EQ(prepared.size(), 98u);
  EXPECT_EQ(prepared.invalid_points, 2u);
  std::vector<bool> seen(cloud.size(), false);
  for (std::size_t k = 0; k < prepared.size(); ++k) {
    const std::uint32_t i = prepared.index[k];
    EXPECT_FALSE(seen[i]);
    seen[i] = true;
    EXPECT_LT((prepared.points[k] + prepared.origin - cloud.points[i]).norm(), 1e-15);
    EXPECT_EQ(prepared.normals[k], cloud.normals[i].normalized());
    EXPECT_EQ(prepared.covariances[k](0, 0), double(i));
  }
}

// Nearest distances of a random sheet of n points on 4 m^2: Rayleigh with median
// sqrt(ln 2 / (pi n / 4)); a median of 2048 is within 4 % of it.
TEST(PreparedCloud, KnowsItsSpacing) {
  PointCloud sheet = test::plane(20000, 2);
  const double expected_m = std::sqrt(std::log(2) / (std::numbers::pi * 200));
  EXPECT_NEAR(prepare(sheet).spacing_m, expected_m, 0.06 * expected_m);
}

TEST(PreparedCloud, ThinnedKeepsOnePointPerVoxel) {
  const PreparedCloud thin = prepare(test::plane(20000, 2), {.thin_m = 0.5});
  EXPECT_EQ(thin.size(), 400u);
}

TEST(PreparedCloud, NormalsComeFromTheNeighboursWhereTheScanHasNone) {
  const PointCloud cloud = test::bumpy_surface(20000, 3);
  PointCloud bare = cloud;
  bare.normals.clear();
  const PreparedCloud prepared = prepare(bare);
  EXPECT_FALSE(prepared.oriented);
  double sum2 = 0;
  for (std::size_t k = 0; k < prepared.size(); ++k)
    sum2 += prepared.normals[k].cross(cloud.normals[prepared.index[k]]).squaredNorm();
  // Patches of 16 points reach 0.03 m at 5000 per m^2: their slopes vary by curvature (up to 3 / m)
  // times that, 0.1 rad, and the fits' means by a few tenths of it.
  EXPECT_LT(std::sqrt(sum2 / double(cloud.size())), 0.03);
}

// H16: normals of something else, or of another frame, are found out; their signs are kept.
TEST(PreparedCloud, WrongNormalsAreReplaced) {
  PointCloud cloud = test::bumpy_surface(5000, 4);
  EXPECT_FALSE(prepare(cloud).normals_refused);
  const std::vector<Vector3d> right = cloud.normals;
  for (Vector3d& n : cloud.normals) n = Eigen::AngleAxisd(0.52, Vector3d::UnitX()) * n;
  const PreparedCloud prepared = prepare(cloud);
  EXPECT_TRUE(prepared.normals_refused);
  EXPECT_TRUE(prepared.oriented);
  std::size_t same = 0;
  for (std::size_t k = 0; k < prepared.size(); ++k)
    same += prepared.normals[k].dot(right[prepared.index[k]]) > 0.9;
  EXPECT_GT(same, prepared.size() * 98 / 100);
}

TEST(PreparedCloud, OfNothingIsEmpty) {
  EXPECT_TRUE(prepare({}).empty());
  PointCloud nothing;
  nothing.points.assign(3, Vector3d::Constant(std::nan("")));
  EXPECT_TRUE(prepare(nothing).empty());
  EXPECT_EQ(prepare(nothing).invalid_points, 3u);
}

TEST(PreparedCloud, RefusesOptionsBeyondTheirLimits) {
  EXPECT_THROW(prepare({}, {.thin_m = -1}), Error);
  EXPECT_THROW(prepare({}, {.neighbours = 5}), Error);
}

}  // namespace
}  // namespace scan
