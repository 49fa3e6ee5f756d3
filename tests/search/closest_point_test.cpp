// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "libscan/core/error.h"
#include "tests/search/clouds.h"

namespace scan {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Corners {
  Eigen::Vector3d a, b, c;
};

// Smallest distance from x to a grid of points of the triangle: above the true one by at most the
// grid's pitch.
double sampled_distance(const Eigen::Vector3d& x, const Corners& t, int steps) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double v = double(i) / steps, w = double(j) / steps;
      best = std::min(best, (t.a + v * (t.b - t.a) + w * (t.c - t.a) - x).norm());
    }
  return best;
}

// The same question answered with 113 bits: the distance to the plane if the foot of the
// perpendicular is inside, else to the nearest edge.
using Quad = __float128;
using Quad3 = std::array<Quad, 3>;

Quad3 quad(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Quad dot(const Quad3& a, const Quad3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Quad3 combine(const Quad3& a, Quad v, const Quad3& b, Quad w, const Quad3& c) {
  return {a[0] + v * b[0] + w * c[0], a[1] + v * b[1] + w * c[1], a[2] + v * b[2] + w * c[2]};
}

Quad3 cross(const Quad3& a, const Quad3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Quad squared_distance_to_segment(const Quad3& x, const Quad3& a, const Quad3& b) {
  const Quad3 ab = combine(b, -1, a, 0, a), ax = combine(x, -1, a, 0, a);
  Quad along = dot(ab, ab) > 0 ? dot(ab, ax) / dot(ab, ab) : 0;
  along = along < 0 ? 0 : along > 1 ? 1 : along;
  const Quad3 rest = combine(ax, -along, ab, 0, ab);
  return dot(rest, rest);
}

double distance_in_quad(const Eigen::Vector3d& x_m, const Corners& t) {
  const Quad3 x = quad(x_m), a = quad(t.a), b = quad(t.b), c = quad(t.c);
  Quad best = squared_distance_to_segment(x, a, b);
  for (const Quad other :
       {squared_distance_to_segment(x, b, c), squared_distance_to_segment(x, c, a)})
    best = other < best ? other : best;
  const Quad3 ab = combine(b, -1, a, 0, a), ac = combine(c, -1, a, 0, a);
  const Quad3 ax = combine(x, -1, a, 0, a);
  const Quad3 normal = cross(ab, ac);
  const Quad normal2 = dot(normal, normal), height = dot(ax, normal);
  const Quad of_b = dot(cross(ax, ac), normal), of_c = dot(cross(ab, ax), normal);
  const bool inside = of_b >= 0 && of_c >= 0 && of_b + of_c <= normal2;
  if (normal2 > 0 && inside) best = height * height / normal2;
  return std::sqrt(static_cast<double>(best));
}

TEST(ClosestPointOnTriangle, IsKnownInEachOfTheSevenRegions) {
  const Eigen::Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto closest = [&](double x, double y) {
    return closest_point_on_triangle({x, y, 3}, a, b, c);
  };
  EXPECT_EQ(closest(1, 1), Eigen::Vector3d(1, 1, 0));  // face
  EXPECT_EQ(closest(-1, -2), a);                       // corners
  EXPECT_EQ(closest(6, -1), b);
  EXPECT_EQ(closest(-1, 6), c);
  EXPECT_EQ(closest(1, -5), Eigen::Vector3d(1, 0, 0));  // edges
  EXPECT_EQ(closest(-5, 3), Eigen::Vector3d(0, 3, 0));
  EXPECT_EQ(closest(4, 4), Eigen::Vector3d(2, 2, 0));
}

TEST(ClosestPointOnTriangle, BeatsADenseSampling) {
  RandomStream random(21, 0, 0);
  for (int i = 0; i < 200; ++i) {
    const Corners t{normal_vector(random), normal_vector(random), normal_vector(random)};
    const Eigen::Vector3d x = 2 * normal_vector(random);
    const double distance = (closest_point_on_triangle(x, t.a, t.b, t.c) - x).norm();
    const double sampled = sampled_distance(x, t, 40);
    const double pitch = ((t.b - t.a).norm() + (t.c - t.a).norm()) / 40;
    EXPECT_LE(distance, sampled + 8 * epsilon);
    EXPECT_GE(distance, sampled - pitch);
  }
}

// From fat triangles to a height of 1e-16 of their length, any corner first; queries all around,
// and straight above or on the inside, where the foot of the perpendicular decides.
TEST(ClosestPointOnTriangle, IsRightToRoundingForFatAndForThinTriangles) {
  RandomStream random(22, 0, 0);
  for (int i = 0; i < 6000; ++i) {
    const double height = std::pow(10.0, -16 * random.uniform());
    const Eigen::Vector3d a = normal_vector(random), b = a + normal_vector(random);
    const Eigen::Vector3d across = normal_vector(random).cross(b - a).normalized();
    const Eigen::Vector3d c = a + random.uniform() * (b - a) + height * across;
    std::array<Eigen::Vector3d, 3> corner = {a, b, c};
    std::rotate(corner.begin(), corner.begin() + i % 3, corner.end());
    const Corners t{corner[0], corner[1], corner[2]};
    const double v = random.uniform() / 2, w = random.uniform() / 2;
    const double above = i % 8 < 4 ? std::pow(10.0, -12 * random.uniform()) : 0;
    const Eigen::Vector3d inside = a + v * (b - a) + w * (c - a);
    const Eigen::Vector3d x =
        i % 2 == 0 ? Eigen::Vector3d(a + 2 * normal_vector(random))
                   : Eigen::Vector3d(inside + above * (b - a).cross(across).normalized());
    const Eigen::Vector3d p = closest_point_on_triangle(x, t.a, t.b, t.c);
    // Some ten roundings of the sizes that enter: the corners' coordinates, edges and way to x.
    const double size = x.norm() + a.norm() + b.norm() + c.norm();
    EXPECT_NEAR((p - x).norm(), distance_in_quad(x, t), 10 * epsilon * size) << "height " << height;
  }
}

TEST(ClosestPointOnTriangle, TakesSegmentsAndPoints) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(3, 0, 0), x(2, 5, 0);
  for (const auto& [p, q, r] : {Corners{a, b, c}, Corners{c, b, a}, Corners{b, c, a}})
    EXPECT_EQ(closest_point_on_triangle(x, p, q, r), Eigen::Vector3d(2, 0, 0));
  EXPECT_EQ(closest_point_on_triangle(x, a, a, c), Eigen::Vector3d(2, 0, 0));
  EXPECT_EQ(closest_point_on_triangle(x, a, c, c), Eigen::Vector3d(2, 0, 0));
  EXPECT_EQ(closest_point_on_triangle(x, b, b, b), b);
}

TEST(ClosestPointOnTriangle, IsTheSameAtAnyScale) {
  // Scaling by a power of two rounds nothing, so the answer scales to the bit.
  RandomStream random(23, 0, 0);
  for (const double scale : {0x1p-60, 0x1p60})
    for (int i = 0; i < 100; ++i) {
      const Corners t{normal_vector(random), normal_vector(random), normal_vector(random)};
      const Eigen::Vector3d x = normal_vector(random);
      const Eigen::Vector3d p = closest_point_on_triangle(x, t.a, t.b, t.c);
      EXPECT_EQ(closest_point_on_triangle(scale * x, scale * t.a, scale * t.b, scale * t.c),
                Eigen::Vector3d(scale * p));
    }
}

Mesh triangle_soup(std::size_t count, double size, const Eigen::Vector3d& offset) {
  RandomStream random(24, 0, 0);
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3d place = offset + 3 * in_cube(random);
    for (int j = 0; j < 3; ++j) mesh.vertices.push_back(place + size * normal_vector(random));
    if (i % 5 == 1) mesh.vertices.back() = mesh.vertices[3 * i];              // a segment
    if (i % 7 == 1) mesh.vertices[3 * i + 1] = mesh.vertices.back() = place;  // or less
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// A square of side `cells` in the plane z = 0, two triangles a cell, and all of it twice.
Mesh doubled_plane(std::uint32_t cells) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) mesh.vertices.emplace_back(x, y, 0);
  for (int copy = 0; copy < 2; ++copy)
    for (std::uint32_t y = 0; y < cells; ++y)
      for (std::uint32_t x = 0; x < cells; ++x) {
        const std::uint32_t v = y * (cells + 1) + x;
        mesh.triangles.push_back({v, v + 1, v + cells + 2});
        mesh.triangles.push_back({v, v + cells + 2, v + cells + 1});
      }
  return mesh;
}

ClosestPoint by_brute_force(const Mesh& mesh, const Eigen::Vector3d& query) {
  ClosestPoint best{query, 0, std::numeric_limits<double>::infinity()};
  double best2 = best.distance_m;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const Eigen::Vector3d p =
        closest_point_on_triangle(query, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    if ((p - query).squaredNorm() >= best2) continue;
    best2 = (p - query).squaredNorm();
    best = {p, i, std::sqrt(best2)};
  }
  return best;
}

void expect_equal(const ClosestPoint& found, const ClosestPoint& expected) {
  EXPECT_EQ(found.triangle, expected.triangle);
  EXPECT_EQ(found.point, expected.point);
  EXPECT_EQ(found.distance_m, expected.distance_m);
}

// One by one, with a guess that is some triangle or none, and all at once.
void expect_brute_force(const Mesh& mesh, const Points& queries) {
  const MeshSearch search(mesh);
  const auto of_each = closest_of_each(search, queries);
  ASSERT_EQ(of_each.size(), queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ClosestPoint expected = by_brute_force(mesh, queries[i]);
    const auto guess = static_cast<std::uint32_t>(i * 7919 % (mesh.triangles.size() + 1));
    expect_equal(search.closest(queries[i]), expected);
    expect_equal(search.closest(queries[i], guess), expected);
    expect_equal(of_each[i], expected);
  }
}

TEST(MeshSearch, AgreesWithBruteForceToTheBit) {
  const Points queries = moved(uniform_cloud(300), 6, {-1, -1, -1});
  for (const std::size_t count : {1, 2, 4, 5, 9, 1000})
    expect_brute_force(triangle_soup(count, 0.1, {0, 0, 0}), queries);
  expect_brute_force(triangle_soup(300, 5, {0, 0, 0}), queries);  // big ones, boxes that overlap
}

TEST(MeshSearch, AgreesWithBruteForceFarFromZero) {
  const Eigen::Vector3d far(1e7, -1e7, 1e7);
  expect_brute_force(triangle_soup(500, 0.1, far), moved(uniform_cloud(200), 4, far));
  expect_brute_force(triangle_soup(500, 0.1, far), uniform_cloud(50));
  // On the mesh itself distances are rounding only, and so is the point's place beside its box.
  const Mesh plane = doubled_plane(12);
  Mesh tilted = plane;
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  for (auto& vertex : tilted.vertices) vertex = turn * vertex / 7 + far;
  Points on_mesh;
  for (const auto& point : moved(uniform_cloud(2000), 12, {0, 0, 0}))
    on_mesh.push_back(turn * Eigen::Vector3d(point.x(), point.y(), 0) / 7 + far);
  expect_brute_force(tilted, on_mesh);
}

// Above a corner of a flat grid up to six triangles are equally near, and their boxes are flat,
// too: at a height that no float has, they seem farther than what is found. From near and from far
// away.
TEST(MeshSearch, PassesByNothingThatRoundingMovesAway) {
  const Mesh mesh = doubled_plane(6);
  for (const double height : {1.0 / 3, 0.7, -0.1, 1e-3}) {
    Mesh raised = mesh;
    for (auto& vertex : raised.vertices) vertex.z() += height;
    const auto first = static_cast<std::uint32_t>(raised.vertices.size());
    for (const double x : {0.0, 1.0, 2.0}) raised.vertices.push_back({x, x * x, -9});
    raised.triangles.push_back({first, first + 1, first + 2});  // takes the origin off the plane
    Points queries;
    for (const auto& vertex : mesh.vertices)
      for (const double above : {1e-9, 2e-7, 5e-7, 1e4, 3e6})
        queries.push_back(vertex + Eigen::Vector3d(0, 0, height + above));
    expect_brute_force(raised, queries);
  }
}

TEST(MeshSearch, TakesTheLowestOfEquallyNearTriangles) {
  Mesh plane = doubled_plane(12);
  Points queries;
  for (double x = -1; x <= 13; x += 0.5)
    for (double y = -1; y <= 13; y += 0.5) queries.emplace_back(x, y, 1.5);  // over corners, edges
  expect_brute_force(plane, queries);
  std::reverse(plane.triangles.begin(), plane.triangles.end());  // now the later side is lowest
  expect_brute_force(plane, queries);
}

TEST(MeshSearch, BuildsTheSameInParallel) {
  // More than the size from which the two halves are built at the same time.
  expect_brute_force(triangle_soup(40000, 0.02, {0, 0, 0}), moved(uniform_cloud(20), 3, {0, 0, 0}));
}

TEST(MeshSearch, FindsNothingNearAQueryThatIsNotFinite) {
  const MeshSearch search(doubled_plane(2));
  const auto found = closest_of_each(search, Points{{0.3, 0.2, 1}, {0, std::nan(""), 0}});
  EXPECT_EQ(found[0].distance_m, 1);
  EXPECT_EQ(found[1].triangle, no_triangle);
  EXPECT_EQ(found[1].distance_m, std::numeric_limits<double>::infinity());
}

TEST(MeshSearch, RefusesAMeshWithoutTriangles) {
  EXPECT_THROW(MeshSearch(Mesh{}), Error);
}

}  // namespace
}  // namespace scan
