// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/rims.h"

#include <gtest/gtest.h>

#include "libscan/align/joint_pairs.h"
#include "tests/align/test_clouds.h"

namespace scan {
namespace {

using Eigen::Vector3d;

// A square of 2 m, points shaken by a third of the spacing of 1 / 15 m.
PointCloud square(std::uint64_t seed) {
  PointCloud cloud;
  for (int i = 0; i < 900; ++i) {
    RandomStream random(seed, 0, std::uint64_t(i));
    const double u = random.uniform(), v = random.uniform();
    const double x = (i % 30 + 0.5 + (u - 0.5) / 1.5) / 15 - 1;
    const double y = (i / 30 + 0.5 + (v - 0.5) / 1.5) / 15 - 1;
    cloud.points.emplace_back(x, y, 0.1 * std::sin(3 * x) * std::cos(2 * y));
  }
  return cloud;
}

// Of a disc of radius r cut off at t r from its middle the mean lies (2 / 3) (1 - t^2)^1.5 / (pi /
// 2 + t sqrt(1 - t^2) + asin t) r away: 0.35 for t = 0.13, below 0.3 from t = 0.24 on and nothing
// from t = 1 on. Sixteen points take a disc of r = 2.3 spacings.
TEST(RimPoints, AreTheOutermostAndNoneInside) {
  const PreparedCloud cloud = prepare(square(1));
  const std::vector<bool> rim = rim_points(cloud);
  ASSERT_EQ(rim.size(), 900u);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vector3d x = cloud.origin + cloud.points[i];
    const double inside = 15 * (1 - x.head<2>().cwiseAbs().maxCoeff());  // spacings
    if (inside < 0.3) {
      EXPECT_TRUE(rim[i]) << x.transpose();
    }
    if (inside > 2.3) {
      EXPECT_FALSE(rim[i]) << x.transpose();
    }
  }
}

TEST(RimPoints, OfFewOrRepeatedPointsAreAnswered) {
  EXPECT_TRUE(rim_points(prepare(PointCloud{})).empty());
  PointCloud same;
  same.points.assign(20, Vector3d(1, 2, 3));
  EXPECT_EQ(rim_points(prepare(same)), std::vector<bool>(20, false));
}

// Where the target's points are all rim none counts; where none is, the more do.
TEST(JointForm, HasNoPartnersOnTheRim) {
  const PreparedCloud source = prepare(square(2)), target = prepare(square(3));
  const Pose world_from_source(Eigen::Translation3d(source.origin + Vector3d(0.7, 0, 0)));
  const Pose world_from_target(Eigen::Translation3d(target.origin));
  const auto pairs = [&](const std::vector<bool>& rim) {
    return joint_form({.source = 0, .target = 1}, source, target, world_from_source,
                      world_from_target, {.method = IcpMethod::point_to_plane}, 0, nullptr, rim)
        .pairs;
  };
  EXPECT_EQ(pairs(std::vector<bool>(target.size(), true)), 0u);
  EXPECT_EQ(pairs(std::vector<bool>(target.size(), false)), pairs({}));
  EXPECT_LT(pairs(rim_points(target)), pairs({}));
}

}  // namespace
}  // namespace scan
