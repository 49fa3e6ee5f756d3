// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/isosurface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

struct TestField {
  OctreeGrid grid;
  LevelArrays coefficients;
};

// Random coefficients: the level set is as wild as it can be, with many ambiguous faces, and cut by
// the walls. Finer levels are active around a few points.
TestField random_field(std::uint64_t seed) {
  TestField field;
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

// at_centre + gradient . (u - centre): a spline's coefficients are then its values in the middles
// of the functions, of which number i has (i - 1/2) cells below it. `scatter` is added to each.
TestField affine_field(double at_centre, const Eigen::Vector3d& gradient, double scatter) {
  TestField field;
  RandomStream random(5, 0, 0);
  field.grid = make_octree_grid(std::vector(1, Eigen::Vector3d(0.5, 0.5, 0.5)),
                                std::vector(1, coarsest_depth), coarsest_depth);
  field.coefficients = active_arrays(field.grid);
  const BlockLevel& level = field.grid.levels.front();
  for (std::size_t i = 0; i < field.coefficients[0].size(); ++i) {
    const int slot = static_cast<int>(i % block_size);
    const BlockPlace& block = level.blocks[i / block_size];
    const Eigen::Vector3d middle(block_width * block[0] + slot % 4 - 0.5,
                                 block_width * block[1] + slot / 4 % 4 - 0.5,
                                 block_width * block[2] + slot / 16 - 0.5);
    const Eigen::Vector3d from_centre = middle / level.cells() - Eigen::Vector3d::Constant(0.5);
    field.coefficients[0][i] = at_centre + gradient.dot(from_centre) + scatter * random.normal();
  }
  return field;
}

// Whatever way the function slopes, where it is negative throughout its level set is the cube.
TEST(ZeroLevelSet, ClosesOnTheWalls) {
  for (const Eigen::Vector3d& gradient :
       {Eigen::Vector3d(0.3, -0.2, 0.1), Eigen::Vector3d(-0.3, 0.2, -0.1)}) {
    const TestField field = affine_field(-1, gradient, 0);
    const Mesh mesh = zero_level_set({field.grid, field.coefficients}, 5);
    for (const auto& v : mesh.vertices)  // 5e-4 is the guard
      ASSERT_LT(std::min(v.minCoeff(), 1 - v.maxCoeff()), 5.1e-4 / 32);
    EXPECT_NEAR(volume_m3(mesh), 1, 6 * 5.1e-4 / 32 + 12 * 0.5 / (32 * 32));  // edges are cut off
  }
}

// Corners of cells lie on the plane, where the function has either sign by rounding alone.
TEST(ZeroLevelSet, IsNotMovedByRounding) {
  for (const double side : {-1.0, 1.0}) {
    const TestField field = affine_field(0, side * Eigen::Vector3d::UnitZ(), 1e-17);
    const Mesh mesh = zero_level_set({field.grid, field.coefficients}, 5);
    for (const auto& v : mesh.vertices) {
      const double to_walls = std::min(v.minCoeff(), 1 - v.maxCoeff());
      ASSERT_LT(std::min(to_walls, std::abs(v[2] - 0.5)), 5.1e-4 / 32);
    }
  }
}

TEST(ZeroLevelSet, IsAClosedManifoldForRandomFunctions) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TestField field = random_field(seed);
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
  const TestField field = random_field(99);
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
