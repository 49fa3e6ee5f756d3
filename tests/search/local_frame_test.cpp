// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/local_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "libscan/search/tree_kernels.h"
#include "tests/search/clouds.h"

namespace scan {
namespace {

TEST(LocalFrame, HoldsEveryCloudInTheUnitCube) {
  for (const auto& [name, points] : hard_clouds(200)) {
    const LocalFrame frame = local_frame(points);
    for (const LocalPoint& point : local_points(points, frame))
      for (const float u : point.at) EXPECT_LE(std::abs(u), 1.0f) << name;
  }
}

TEST(LocalFrame, UsesAtLeastHalfOfTheCube) {
  // Else the floats would waste their bits: the scale is the smallest power of two that fits.
  const Points points = moved(uniform_cloud(1000), 3e-5, {1e7, 0, 0});
  float largest = 0;
  for (const LocalPoint& point : local_points(points, local_frame(points)))
    for (const float u : point.at) largest = std::max(largest, std::abs(u));
  EXPECT_GE(largest, 0.5f);
}

// The promise on which the float searches rest, at its own bound: a point at distance d is never
// screened out by limit2(d^2), whatever the cloud and the query.
TEST(LocalQuery, NeverScreensOutAPointOnTheLimit) {
  RandomStream random(5, 0, 0);
  std::size_t tried = 0;
  for (const auto& [name, points] : hard_clouds(300)) {
    const LocalFrame frame = local_frame(points);
    for (const LocalPoint& point : local_points(points, frame)) {
      const double reach = std::pow(10.0, 12 * random.uniform() - 9) / frame.units_per_m;
      const Eigen::Vector3d query_m = points[point.index] + reach * normal_vector(random);
      const LocalQuery query(frame, query_m);
      float distance2 = 0;
      for (int axis = 0; axis < 3; ++axis)
        distance2 += (point.at[axis] - query.at[axis]) * (point.at[axis] - query.at[axis]);
      EXPECT_LE(distance2, query.limit2(squared_distance_m2(points[point.index], query_m))) << name;
      ++tried;
    }
  }
  EXPECT_GT(tried, 3000u);
}

// The promise on which the choice among candidates rests: of two points, the farther in truth never
// makes the nearer one look as if it were out of the running.
TEST(LocalQuery, WidensEnoughForEveryPointThatIsAsNear) {
  RandomStream random(6, 0, 0);
  std::size_t nearly_equal = 0;
  for (const auto& [name, points] : hard_clouds(300)) {
    const LocalFrame frame = local_frame(points);
    const LargeArray<LocalPoint> local = local_points(points, frame);
    for (std::size_t i = 0; i + 1 < local.size(); ++i) {
      const Eigen::Vector3d &a = points[local[i].index], &b = points[local[i + 1].index];
      // Near the plane between the two.
      const Eigen::Vector3d middle = a + (b - a) / 2, across = normal_vector(random).cross(b - a);
      const Eigen::Vector3d query_m = middle + std::pow(10.0, 6 * random.uniform() - 3) * across;
      const LocalQuery query(frame, query_m);
      const auto float_distance2 = [&](const LocalPoint& point) {
        float sum = 0;
        for (int axis = 0; axis < 3; ++axis)
          sum += (point.at[axis] - query.at[axis]) * (point.at[axis] - query.at[axis]);
        return sum;
      };
      const bool a_first = squared_distance_m2(a, query_m) <= squared_distance_m2(b, query_m);
      const float nearer2 = float_distance2(local[a_first ? i : i + 1]);
      const float farther2 = float_distance2(local[a_first ? i + 1 : i]);
      EXPECT_LE(nearer2, widened(farther2, query.widening())) << name;
      if (farther2 < nearer2) ++nearly_equal;
    }
  }
  EXPECT_GT(nearly_equal, 100u);  // those that float puts the wrong way round
}

// And it screens: beyond twice the slack and 2^-19 of the distance nothing gets through.
TEST(LocalQuery, ScreensOutWhatRoundingCannotExplain) {
  const LocalFrame frame{Eigen::Vector3d::Zero(), 1};
  const LocalQuery query(frame, {0.25, 0, 0});
  const double limit = 0.5, beyond = (limit + 2 * query.slack) * (1 + 0x1p-19);
  EXPECT_LT(query.limit2(limit * limit), beyond * beyond);
  EXPECT_EQ(query.limit2(-1), -1);
  EXPECT_EQ(query.limit2(unlimited_m), std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace scan
