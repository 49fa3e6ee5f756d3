// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/followed_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/core/error.h"

namespace scan {
namespace {

const Eigen::Vector3d centre(0.5, 0.5, 0.5);

double ball(const Eigen::Vector3d& u) {
  return (u - centre).norm() - 0.3;
}

// From one seed all round the sphere; vertices are roots of a function that is nearly linear along
// an edge of 1/64: four steps leave nothing.
TEST(FollowedSurface, GoesAllRoundFromOneSeed) {
  const std::vector<Eigen::Vector3d> seed{{0.8, 0.5, 0.5}};
  const Mesh mesh = followed_surface(seed, 6, ball);
  const EdgeCensus census = edge_census(mesh);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 0);
  for (const auto& v : mesh.vertices) EXPECT_NEAR(ball(v), 0, 1e-5);
  // Facets of 1/64 on a radius of 0.3 lose (1/64)^2 / (2 x 0.3^2), 0.14 %.
  EXPECT_NEAR(volume_m3(mesh), 4 * std::numbers::pi / 3 * 0.027, 2e-3 * 0.113);
}

// The cells about a seed are looked into only where nothing crosses its own and those about it:
// seeds on the surface cost no value of the field that following from one does not ask for.
TEST(FollowedSurface, LooksAboutSeedsThatLieOffIt) {
  std::atomic<int> values = 0;
  const UnitField counted = [&](const Eigen::Vector3d& u) {
    ++values;
    return ball(u);
  };
  std::vector<Eigen::Vector3d> seeds{{0.8, 0.5, 0.5}};
  const Mesh from_one = followed_surface(seeds, 6, counted);
  const int of_one = values.exchange(0);
  for (int i = 0; i < 1000; ++i) {  // a spiral
    const double z = (i + 0.5) / 500 - 1, turn = 2.4 * i, r = std::sqrt(1 - z * z);
    seeds.push_back(centre + 0.3 * Eigen::Vector3d(r * std::cos(turn), r * std::sin(turn), z));
  }
  EXPECT_TRUE(followed_surface(seeds, 6, counted).triangles == from_one.triangles);
  // Seeds that rounding puts a cell off ask for the corners of their own.
  EXPECT_LT(values, of_one + 20);
  const std::vector<Eigen::Vector3d> beside{{0.8 + 1.3 / 64, 0.5, 0.5}};
  EXPECT_TRUE(followed_surface(beside, 6, ball).triangles == from_one.triangles);
}

TEST(FollowedSurface, EndsWhereTheFieldIsUnknown) {
  const std::vector<Eigen::Vector3d> seed{{0.8, 0.5, 0.5}};
  const Mesh mesh = followed_surface(seed, 6, [](const Eigen::Vector3d& u) {
    return u[0] > 0.5 ? ball(u) : std::numeric_limits<double>::quiet_NaN();
  });
  const EdgeCensus census = edge_census(mesh);
  EXPECT_GT(census.boundary_edges, 0u);
  EXPECT_EQ(census.non_manifold_edges, 0u);
  EXPECT_EQ(census.misoriented_edges, 0u);
  for (const auto& v : mesh.vertices) EXPECT_GT(v[0], 0.5);
}

// A field with cells of every kind: random corner signs, as a hash of the place.
TEST(FollowedSurface, IsManifoldOnARandomField) {
  std::vector<Eigen::Vector3d> seeds;
  for (int i = 0; i < 512; ++i)
    seeds.push_back(Eigen::Vector3d(i % 8 + 0.5, i / 8 % 8 + 0.5, i / 64 + 0.5) / 8);
  const Mesh mesh = followed_surface(seeds, 3, [](const Eigen::Vector3d& u) {
    if (u.minCoeff() <= 0 || u.maxCoeff() >= 1) return 1.0;
    return std::sin(1e4 * u.dot(Eigen::Vector3d(1.3, 2.7, 3.1)));
  });
  const EdgeCensus census = edge_census(mesh);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
}

// The eighth of a ball, six cells wide, in the far corner: there places have the largest numbers.
// Vertices are found to 1e-5 of the larger value at an edge's ends, which is below a cell.
TEST(FollowedSurface, ReachesTheFarWallsOfTheFinestCells) {
  const double cell = std::ldexp(1.0, -20), radius = 5.8 * cell;
  const std::vector<Eigen::Vector3d> seed{{1 - radius, 1, 1}};
  const auto eighth = [&](const Eigen::Vector3d& u) {
    return (u - Eigen::Vector3d::Ones()).norm() - radius;
  };
  const Mesh mesh = followed_surface(seed, 20, eighth);
  for (const auto& v : mesh.vertices) EXPECT_NEAR(eighth(v), 0, 1.1e-5 * cell);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_TRUE(std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                            [&](const auto& v) { return v[axis] == 1; }));
  const EdgeCensus census = edge_census(mesh);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.non_manifold_edges, 0u);
  // Facets whose corners lie within a cell of their middle lose up to (1 / 5.8)^2 / 4 of a sphere's
  // area, and chords along the walls as much again: 1.5 %.
  const double expected = std::numbers::pi / 2 * radius * radius;
  EXPECT_NEAR(area_m2(mesh), expected, 0.015 * expected);
  EXPECT_THROW(followed_surface(seed, 21, eighth), Error);
}

TEST(FollowedSurface, RefusesTooManyCells) {
  const std::vector<Eigen::Vector3d> seed{{0.8, 0.5, 0.5}};
  EXPECT_THROW(followed_surface(seed, 6, ball, 100), Error);
}

}  // namespace
}  // namespace scan
