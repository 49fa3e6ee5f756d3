// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/isosurface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

struct RandomField {
  OctreeGrid grid;
  LevelArrays coefficients;
};

// Random coefficients: the level set is as wild as it can be, with many ambiguous faces, and cut by
// the walls. Finer levels are active around a few points.
RandomField random_field(std::uint64_t seed) {
  RandomField field;
  RandomStream random(seed, 0, 0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4; ++i)
    points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  field.grid = make_octree_grid(points, std::vector<int>(4, 5), 3);
  field.coefficients = active_arrays(field.grid);
  for (auto& level : field.coefficients)
    for (double& c : level) c = random.normal();
  return field;
}

TEST(ZeroLevelSet, IsAClosedManifoldForRandomFunctions) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const RandomField field = random_field(seed);
    const Mesh mesh = zero_level_set({field.grid, field.coefficients}, 5);
    const EdgeCensus census = edge_census(mesh);
    EXPECT_TRUE(census.watertight) << "seed " << seed;
    EXPECT_EQ(census.non_manifold_edges, 0u);
    EXPECT_EQ(census.misoriented_edges, 0u);
    EXPECT_GT(volume_m3(mesh), 0);
    for (const Triangle& t : mesh.triangles) ASSERT_GT(area_vector(mesh, t).norm(), 0);
  }
}

TEST(ZeroLevelSet, HasItsVerticesOnTheZeroSet) {
  const RandomField field = random_field(99);
  const SplineField spline{field.grid, field.coefficients};
  const Mesh mesh = zero_level_set(spline, 6);
  const double cell = 1.0 / 64;
  std::size_t off = 0, inner = 0;
  for (const auto& v : mesh.vertices) {
    if (v.minCoeff() < cell || v.maxCoeff() > 1 - cell) continue;  // the closing walls
    ++inner;
    const FieldValue f = evaluate(spline, v);
    // First-order distance; the snap guard may move a vertex by 5e-4 of a cell.
    off += std::abs(f.value) > 1e-3 * cell * f.gradient.norm();
  }
  ASSERT_GT(inner, 1000u);
  // Centres of polygons whose Newton steps would leave their cell stay where they are: rare, and
  // only where the function bends within a cell.
  EXPECT_LT(static_cast<double>(off), 2e-3 * static_cast<double>(inner));
}

}  // namespace
}  // namespace scan
