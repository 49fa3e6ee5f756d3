// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/collapsing_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scan {
namespace {

Mesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

// Two triangles wide, four long, all in one plane.
Mesh strip() {
  Mesh mesh;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 5; ++i) mesh.vertices.push_back({double(i), double(j), 0});
  for (std::uint32_t j = 0; j < 2; ++j)
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t a = i + 5 * j;
      mesh.triangles.push_back({a, a + 1, a + 6});
      mesh.triangles.push_back({a, a + 6, a + 5});
    }
  return mesh;
}

TEST(CollapsingMesh, StaysClosed) {
  CollapsingMesh mesh(octahedron());
  EXPECT_EQ(mesh.neighbours(4), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  const Eigen::Vector3d place(0.5, 0, 0.5);
  ASSERT_TRUE(mesh.may_collapse(0, 4, place));
  mesh.collapse(0, 4, place);
  EXPECT_EQ(mesh.alive(), 6u);
  const EdgeCensus census = edge_census(mesh.mesh());
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.genus, 0);
  EXPECT_EQ(census.used_vertices, 5u);
  // Now vertices 2 and 3 have three triangles each: merging their neighbours would lay two on one
  // another.
  EXPECT_FALSE(mesh.may_collapse(0, 1, Eigen::Vector3d::Zero()));
}

TEST(CollapsingMesh, RefusesToFoldOver) {
  const CollapsingMesh mesh(strip());
  EXPECT_TRUE(mesh.may_collapse(6, 7, {1.5, 1, 0}));
  EXPECT_FALSE(mesh.may_collapse(6, 7, {3.5, 1, 0}));
}

// A tube of three sides: merging two vertices of a ring would pinch it shut, though nothing folds.
TEST(CollapsingMesh, RefusesToPinchATube) {
  Mesh tube;
  for (int ring = 0; ring < 5; ++ring)
    for (int i = 0; i < 3; ++i)
      tube.vertices.push_back({std::cos(2.1 * i), std::sin(2.1 * i), 10.0 * ring});
  for (std::uint32_t ring = 0; ring < 4; ++ring)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t a = 3 * ring + i, b = 3 * ring + (i + 1) % 3;
      tube.triangles.push_back({a, b, b + 3});
      tube.triangles.push_back({a, b + 3, a + 3});
    }
  const CollapsingMesh mesh(tube);
  EXPECT_FALSE(mesh.may_collapse(6, 7, tube.vertices[6]));
  EXPECT_FALSE(mesh.may_collapse(6, 7, (tube.vertices[6] + tube.vertices[7]) / 2));
  EXPECT_FALSE(mesh.may_collapse(6, 7, (9 * tube.vertices[6] + tube.vertices[7]) / 10));
}

TEST(CollapsingMesh, FlipsAnEdge) {
  // A parallelogram cut along its long diagonal.
  CollapsingMesh mesh({{{0, 0, 0}, {2, 0, 0}, {3, 2, 0}, {1, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  EXPECT_FALSE(mesh.may_flip(0, 1));  // on the rim
  ASSERT_TRUE(mesh.may_flip(0, 2));
  mesh.flip(0, 2);
  EXPECT_EQ(mesh.neighbours(1), (std::vector<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(mesh.around(0).size(), 1u);
  EXPECT_EQ(mesh.around(3).size(), 2u);
  EXPECT_NEAR(area_m2(mesh.mesh()), 4, 1e-12);
  EXPECT_EQ(edge_census(mesh.mesh()).misoriented_edges, 0u);
  EXPECT_FALSE(mesh.may_flip(1, 3));                          // back again: thinner
  EXPECT_FALSE(CollapsingMesh(octahedron()).may_flip(0, 2));  // it would fold
  // Of two slivers, unless their other diagonal is an edge already.
  Mesh line{{{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_TRUE(CollapsingMesh(line).may_flip(0, 1));
  line.triangles.push_back({2, 3, 4});
  EXPECT_FALSE(CollapsingMesh(line).may_flip(0, 1));
}

TEST(CollapsingMesh, RefusesABridgeBetweenRims) {
  const CollapsingMesh mesh(strip());
  EXPECT_TRUE(mesh.is_on_rim(1));
  EXPECT_FALSE(mesh.is_on_rim(6));
  CollapsingMesh narrow(strip());
  narrow.collapse(6, 7, {1.5, 1, 0});
  narrow.collapse(6, 8, {2, 1, 0});
  EXPECT_TRUE(edge_census(narrow.mesh()).non_manifold_edges == 0);
  // Both on the rim, the edge between them not.
  Mesh bow{{{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {2, 0, 0}}, {{0, 2, 1}, {1, 2, 3}}};
  EXPECT_FALSE(CollapsingMesh(bow).may_collapse(1, 2, {1, 0, 0}));
}

}  // namespace
}  // namespace scan
