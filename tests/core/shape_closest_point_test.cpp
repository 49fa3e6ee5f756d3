// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The nearest point of a shape against a dense set of its points, and where it is known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/core/shape_cases.h"

namespace scan::test {
namespace {

// The closest point lies on the surface, and none of many other surface points is nearer.
void expect_closest(const std::string& name, const Shape& shape, double reach_m) {
  const PlacedShape placed{Pose::Identity(), shape};
  const auto brute = surface_points(shape, 4000);
  ASSERT_GT(brute.size(), 500u) << name;
  int farther = 0, tried = 0;
  double worst = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    RandomStream random(7, 0, i);
    const Eigen::Vector3d x = point_in_cube(random, 1);
    if (std::abs(field(shape, x).value_m) > reach_m) continue;
    ++tried;
    const Eigen::Vector3d p = closest_point(placed, x);
    EXPECT_LT(std::abs(field(shape, p).value_m), 1e-12) << name;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& q : brute) nearest = std::min(nearest, (q - x).norm());
    const double excess = (p - x).norm() - nearest;
    farther += excess > 1e-9;
    worst = std::max(worst, excess);
  }
  EXPECT_GT(tried, 50) << name;
  EXPECT_EQ(farther, 0) << name << " of " << tried << ", worst by " << worst << " m";
}

TEST(ClosestPoint, IsAsNearAsAnySurfacePoint) {
  for (const ShapeCase& c : all_cases()) expect_closest(c.name, c.shape, 0.1);
  expect_closest("filleted", filleted(), 0.1);
}

// Two unit spheres whose seam is the circle x = 0 of radius 0.8. On the axis through both centres
// every gradient is parallel; the nearest surface of the union is the seam (or, beyond the centres,
// the far side of a sphere).
TEST(ClosestPoint, OfAUnionIsNotBuriedOnItsAxis) {
  const PlacedShape both{
      Pose::Identity(),
      CombinedShape{
          Operation::unite, 0, {at(-0.6, 0, 0, SphereShape{1}), at(0.6, 0, 0, SphereShape{1})}}};
  for (const double x : {-0.4, -0.1, 0.0, 0.3, 0.4})
    EXPECT_NEAR((closest_point(both, {x, 0, 0}) - Eigen::Vector3d(x, 0, 0)).norm(),
                std::min(std::hypot(x, 0.8), 1.6 - std::abs(x)), 1e-9)
        << x;
}

// Two half-spaces meet in an edge; the foot is on a face or on the edge.
TEST(ClosestPoint, FindsTheEdgeOfAWedge) {
  for (const double half_angle : {0.2, 0.5, 1.0, 1.4}) {
    // the solid |x| < z tan(half_angle), edge along y, opening towards +z
    const auto half_space = [&](double side) {
      return PlacedShape{pose_of(0, side * (std::numbers::pi / 2 + half_angle), 0, 0, 0, 0),
                         PlaneShape{}};
    };
    const PlacedShape wedge{
        Pose::Identity(), CombinedShape{Operation::intersect, 0, {half_space(1), half_space(-1)}}};
    for (std::uint64_t i = 0; i < 300; ++i) {
      RandomStream random(8, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1);
      // nearest on the face of the same side, whose direction from the edge is (sin, cos)
      const double along =
          std::max(0.0, std::abs(x.x()) * std::sin(half_angle) + x.z() * std::cos(half_angle));
      const double expected = std::hypot(std::abs(x.x()) - along * std::sin(half_angle),
                                         x.z() - along * std::cos(half_angle));
      const double found = (closest_point(wedge, x) - x).norm();
      EXPECT_NEAR(found, expected, 1e-9 * expected + 1e-15) << half_angle << " " << x.transpose();
    }
  }
}

}  // namespace
}  // namespace scan::test
