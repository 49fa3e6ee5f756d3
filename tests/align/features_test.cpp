// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/features.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/align/global_scenes.h"

namespace scan {
namespace {

PointCloud scaled(PointCloud cloud, double factor) {
  for (Eigen::Vector3d& x : cloud.points) x *= factor;
  return cloud;
}

// Powers of two scale without rounding, so everything is the same to the bit.
TEST(Features, HaveNoUnit) {
  const PointCloud cloud = test::lump(9000, 1);
  for (const double factor : {0x1p-20, 0x1p20}) {
    const PointCloud other = scaled(cloud, factor);
    const double side_m = feature_side_m({&cloud, 1});
    EXPECT_EQ(feature_side_m({&other, 1}), factor * side_m);
    EXPECT_EQ(describe(other, factor * side_m).descriptors, describe(cloud, side_m).descriptors);
  }
}

TEST(Features, SideLeavesSomeThousandPoints) {
  for (const PointCloud& cloud : {test::lump(20000, 1), test::furnished_room(40000, 1)}) {
    const std::size_t left = describe(cloud, feature_side_m({&cloud, 1})).cloud.size();
    EXPECT_GT(left, 2500u);
    EXPECT_LT(left, 3500u);
  }
}

TEST(Features, SideIsTheMiddleOneOfTheClouds) {
  const PointCloud a = test::lump(5000, 1);
  const std::vector<PointCloud> clouds = {scaled(a, 100), a, scaled(a, 0.25)};
  EXPECT_EQ(feature_side_m(clouds), feature_side_m({&clouds[1], 1}));
}

TEST(Features, PointsThatSayNothingAreLeftOut) {
  PointCloud cloud = test::lump(3000, 1);
  const double side_m = feature_side_m({&cloud, 1});
  const ScanFeatures clean = describe(cloud, side_m);
  cloud.points.emplace_back(NAN, 0, 0);
  cloud.normals.emplace_back(0, 0, 1);
  cloud.points.emplace_back(0, 0, 0);
  cloud.normals.push_back(Eigen::Vector3d::Zero());
  cloud.points.emplace_back(INFINITY, 0, 0);
  cloud.normals.emplace_back(0, 0, 1);
  EXPECT_EQ(describe(cloud, side_m).descriptors, clean.descriptors);
}

TEST(Features, NothingToDescribeIsNoFailure) {
  const PointCloud none, one{.points = {{1, 2, 3}}, .normals = {{0, 0, 1}}};
  EXPECT_EQ(feature_side_m({}), 0);
  EXPECT_EQ(feature_side_m({&none, 1}), 0);
  EXPECT_EQ(feature_side_m({&one, 1}), 0);
  EXPECT_TRUE(describe(none, 1).cloud.empty());
  EXPECT_EQ(describe(one, 1).descriptors, std::vector<float>(ScanFeatures::dimensions, 0));
}

TEST(Features, RefuseACloudWithoutNormalsAndASideThatIsNone) {
  PointCloud cloud = test::plane(100, 1);
  for (const double side_m : {0.0, -1.0, double(NAN)}) EXPECT_THROW(describe(cloud, side_m), Error);
  cloud.normals.clear();
  EXPECT_THROW(describe(cloud, 1), Error);
}

}  // namespace
}  // namespace scan
