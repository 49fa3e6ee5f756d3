// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Arrays of a cloud stay together through every operation.
#include "libscan/core/point_cloud.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "libscan/core/error.h"

namespace scan {
namespace {

PointCloud three_points() {
  PointCloud cloud;
  for (int i = 0; i < 3; ++i) {
    cloud.points.emplace_back(i, 2 * i, 3 * i);
    cloud.normals.push_back(Eigen::Vector3d::Unit(i));
    cloud.sigma_m.push_back(0.1 * i);
    cloud.covariances.push_back(Eigen::Vector3d(1 + i, 2, 3).asDiagonal());
    cloud.intensity.push_back(10 * i);
  }
  return cloud;
}

TEST(PointCloud, CheckNamesTheArrayOfTheWrongLength) {
  PointCloud cloud = three_points();
  EXPECT_NO_THROW(check(cloud));
  cloud.sigma_m.pop_back();
  try {
    check(cloud);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("sigma_m"), std::string::npos);
  }
}

// The squared Mahalanobis distance of a displacement does not depend on the frame.
TEST(PointCloud, TransformCarriesEachArray) {
  Vector6 twist;
  twist << 0.3, -1, 0.5, 1, 2, 3;
  const Pose a_from_b = exp(twist);
  const PointCloud in_b = three_points(), in_a = transformed(a_from_b, in_b);
  const Eigen::Vector3d step(0.2, 0.5, -1);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((a_from_b.inverse() * in_a.points[i] - in_b.points[i]).norm(), 1e-14);
    EXPECT_LT((in_a.normals[i] - a_from_b.linear() * in_b.normals[i]).norm(), 1e-15);
    const Eigen::Vector3d turned = a_from_b.linear() * step;
    EXPECT_NEAR(turned.dot(in_a.covariances[i] * turned), step.dot(in_b.covariances[i] * step),
                1e-14);
  }
  EXPECT_EQ(in_a.sigma_m, in_b.sigma_m);
  EXPECT_EQ(in_a.intensity, in_b.intensity);
}

TEST(PointCloud, SubsetKeepsTheOrderOfTheIndices) {
  const std::array<std::uint32_t, 2> indices{2, 0};
  const PointCloud picked = subset(three_points(), indices);
  EXPECT_NO_THROW(check(picked));
  EXPECT_EQ(picked.points[0], Eigen::Vector3d(2, 4, 6));
  EXPECT_EQ(picked.intensity, (std::vector<double>{20, 0}));
  EXPECT_EQ(picked.normals[0], Eigen::Vector3d::UnitZ().eval());
}

TEST(PointCloud, AppendDropsAnArrayThatOneSideLacks) {
  PointCloud cloud = three_points(), other = three_points();
  other.normals.clear();
  append(cloud, other);
  EXPECT_NO_THROW(check(cloud));
  EXPECT_EQ(cloud.size(), 6u);
  EXPECT_TRUE(cloud.normals.empty());
  EXPECT_EQ(cloud.sigma_m.size(), 6u);
}

TEST(PointCloud, AppendToAnEmptyCloudCopies) {
  PointCloud cloud;
  append(cloud, three_points());
  EXPECT_EQ(cloud.normals.size(), 3u);
  EXPECT_EQ(cloud.points.size(), 3u);
}

TEST(PointCloud, FinitePointsLeavesOutEachKindOfNaN) {
  PointCloud cloud = three_points();
  cloud.points[0].y() = std::numeric_limits<double>::infinity();
  cloud.normals[2].x() = std::nan("");
  EXPECT_EQ(finite_points(cloud), (std::vector<std::uint32_t>{1}));
}

TEST(PointCloud, BoundsIgnoreWhatIsNotFinite) {
  PointCloud cloud = three_points();
  cloud.points.emplace_back(std::nan(""), 0, 100);
  const Bounds box = bounds_of(cloud.points);
  EXPECT_EQ(box.max(), Eigen::Vector3d(2, 4, 6));
  EXPECT_TRUE(bounds_of(std::vector<Eigen::Vector3d>{}).isEmpty());
}

}  // namespace
}  // namespace scan
