// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The bounds that let a search pass by triangles: below the distance always, at it nearly always.
#include "libscan/search/triangle_leaf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libscan/core/random.h"
#include "libscan/search/closest_point.h"
#include "libscan/search/local_frame.h"

namespace scan {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

Eigen::Vector3d uniform_in_box(RandomStream& random, double half) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return half * (2 * Eigen::Vector3d(x, y, z).array() - 1);
}

// Within the unit box that local coordinates keep to: fat, small, needles down to rounding,
// segments and points.
Corners some_triangle(RandomStream& random, std::uint64_t number) {
  const Eigen::Vector3d a = uniform_in_box(random, 0.9), ab = uniform_in_box(random, 0.09),
                        ac = uniform_in_box(random, 0.09);
  const double share = random.uniform();
  const double thin = std::pow(10, -17 * random.uniform());
  switch (number % 5) {
    case 0:
      return {a, a + ab, a + ac};
    case 1:
      return {a, a + thin * ab, a + thin * ac};
    case 2:
      return {a, a + ab, a + share * ab + thin * ac};
    case 3:
      return {a, a + ab, a + share * ab};
    default:
      return {a, a, a};
  }
}

float bound2_of(const Corners& corners, const Eigen::Vector3d& query) {
  TriangleLeaf leaf{};
  leaf.count = 1;
  leaf.set(0, corners);
  const LocalQuery local(LocalFrame{}, query);
  const __m128 at[3] = {_mm_set1_ps(local.at[0]), _mm_set1_ps(local.at[1]),
                        _mm_set1_ps(local.at[2])};
  alignas(16) float bounds2[TriangleLeaf::width];
  EXPECT_EQ(leaf.within(at, std::numeric_limits<float>::infinity(), bounds2), 1u);
  return bounds2[0];
}

// Queries on the triangle, near it, and up to sixteen sizes of the mesh away.
Eigen::Vector3d some_query(RandomStream& random, const Corners& corners, std::uint64_t number) {
  const double u = random.uniform(), v = random.uniform();
  const Eigen::Vector3d on = corners[0] + std::min(u, v) * (corners[1] - corners[0]) +
                             (1 - std::max(u, v)) * (corners[2] - corners[0]);
  const double far = std::pow(10, -9 + 10 * random.uniform());
  return number % 3 == 0 ? on : on + uniform_in_box(random, far);
}

struct Case {
  Corners corners;
  Eigen::Vector3d query, nearest;
  double distance = 0;
  LocalQuery local;
};

Case some_case(std::uint64_t number) {
  RandomStream random(41, 0, number);
  const Corners corners = some_triangle(random, number / 3);
  const Eigen::Vector3d query = some_query(random, corners, number);
  const Eigen::Vector3d nearest =
      closest_point_on_triangle(query, corners[0], corners[1], corners[2]);
  LocalQuery local(LocalFrame{}, query);
  local.slack *= TriangleLeaf::leaf_slack;
  return {corners, query, nearest, (query - nearest).norm(), local};
}

// Needles whose corners' rounding leaves a normal along them, one in a hundred of these: the
// half-spaces of their edges must be at right angles to it all the same.
TEST(TriangleLeaf, BoundsDistancesToNeedlesAlongTheirNormal) {
  int along = 0;
  for (std::uint64_t number = 0; number < 100'000; ++number) {
    RandomStream random(43, 0, number);
    const double off = std::pow(2, -20 - 30 * random.uniform()), share = random.uniform(),
                 at = random.uniform();
    const Eigen::Vector3d jitter = uniform_in_box(random, off), away = uniform_in_box(random, 0.3);
    const Eigen::Vector3d way = 0.25 * (Eigen::Vector3d(1, 1, 0) + jitter);
    const Corners corners = {Eigen::Vector3d::Zero(), way, share * way};
    const Eigen::Vector3d query = 2 * at * way + away, normal = way.cross(share * way);
    along += std::abs(normal.dot(way)) > 0.999 * normal.norm() * way.norm() && normal.norm() > 0;
    LocalQuery local(LocalFrame{}, query);
    local.slack *= TriangleLeaf::leaf_slack;
    const Eigen::Vector3d nearest =
        closest_point_on_triangle(query, corners[0], corners[1], corners[2]);
    ASSERT_LE(bound2_of(corners, query), local.limit2((query - nearest).squaredNorm())) << number;
  }
  EXPECT_GT(along, 500);
}

// As the search asks: a bound above the limit of the true distance would pass the triangle by.
TEST(TriangleLeaf, BoundsDistancesFromBelow) {
  for (std::uint64_t number = 0; number < 300'000; ++number) {
    const Case c = some_case(number);
    ASSERT_LE(bound2_of(c.corners, c.query), c.local.limit2(c.distance * c.distance)) << number;
  }
}

// The squares of such lengths have hardly a digit: a normal of 1.2 would make 0.6 of 0.5.
TEST(TriangleLeaf, HasNoNormalWhereLengthsUnderflow) {
  const Corners tiny = {Eigen::Vector3d::Zero(), {2.7e-81, 0, 0}, {0, 1e-81, 0}};
  EXPECT_LE(bound2_of(tiny, {0, 0, 0.5}), 0.25f);
}

// By the same rounding, for triangles that have a normal to speak of; off corners it is less.
TEST(TriangleLeaf, BoundsByTheDistanceItselfBesideFacesAndEdges) {
  int tried = 0;
  for (std::uint64_t number = 0; number < 100'000; ++number) {
    const Case c = some_case(number);
    if (number / 3 % 5 != 0) continue;
    bool is_corner = false;
    for (const Eigen::Vector3d& corner : c.corners) is_corner |= (corner - c.nearest).norm() < 1e-9;
    if (is_corner) continue;
    ++tried;
    EXPECT_GE(std::sqrt(bound2_of(c.corners, c.query)), c.distance * (1 - 0x1p-20) - c.local.slack)
        << number;
  }
  EXPECT_GT(tried, 5'000);
}

// Whatever the limit: what no triangle stands in is no triangle.
TEST(TriangleLeaf, NamesNoTriangleBeyondItsCount) {
  TriangleLeaf leaf{};
  const __m128 at[3] = {_mm_set1_ps(0), _mm_set1_ps(0), _mm_set1_ps(0)};
  alignas(16) float bounds2[TriangleLeaf::width];
  for (std::uint32_t count = 0; count <= TriangleLeaf::width; ++count) {
    leaf.count = count;
    EXPECT_EQ(leaf.within(at, 1, bounds2), (1u << count) - 1);
    EXPECT_EQ(leaf.within(at, std::numeric_limits<float>::infinity(), bounds2), (1u << count) - 1);
  }
}

}  // namespace
}  // namespace scan
