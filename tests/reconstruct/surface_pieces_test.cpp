// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace scan {
namespace {

// About a corner of the cells at the origin: one face in each of the eight.
Mesh octahedron() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5})
      mesh.vertices.push_back(side * Eigen::Vector3d::Unit(axis));
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t x = i & 1, y = i >> 1 & 1, z = i >> 2;
    Triangle t{x, 2 + y, 4 + z};
    if ((x + y + z) % 2 == 0) std::swap(t[0], t[1]);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

// The octahedron's dual is the cube: eight corners, six quads, each edge run through once each way.
TEST(SurfacePieces, OfAnOctahedronMakeACube) {
  const Mesh mesh = octahedron();
  ASSERT_GT(volume_m3(mesh), 0);
  SurfacePieces pieces = pieces_in_cells(mesh, {.side_m = 1});
  EXPECT_EQ(pieces.count, 8u);
  const PiecePolygons polygons = polygons_between(mesh, pieces);
  EXPECT_EQ(polygons.sizes, std::vector<std::uint32_t>(6, 4));
  Mesh cube;
  cube.vertices.resize(8);
  for (std::size_t t = 0; t < 8; ++t) cube.vertices[t] = area_vector(mesh, mesh.triangles[t]);
  for (std::size_t i = 0; i < 24; i += 4) {
    const std::uint32_t* c = polygons.corners.data() + i;
    cube.triangles.push_back({c[0], c[1], c[2]});
    cube.triangles.push_back({c[0], c[2], c[3]});
  }
  EXPECT_TRUE(edge_census(cube).watertight);
  EXPECT_NEAR(volume_m3(cube), 0.125, 1e-15);  // corners at (+-1/4, +-1/4, +-1/4)
}

// In one cell the whole surface is one piece; nothing meets.
TEST(SurfacePieces, HangTogetherWithinACell) {
  const Mesh mesh = octahedron();
  const CellGrid cells{.origin_m = Eigen::Vector3d::Constant(-1), .side_m = 2};
  SurfacePieces pieces = pieces_in_cells(mesh, cells);
  EXPECT_EQ(pieces.count, 1u);
  EXPECT_TRUE(polygons_between(mesh, pieces).sizes.empty());
}

// Two triangles of one cell that share a corner only are two pieces; so are two components.
TEST(SurfacePieces, ArePartedWhereNoEdgeJoinsThem) {
  Mesh mesh = octahedron();
  mesh.triangles = {mesh.triangles[0], mesh.triangles[3]};
  const CellGrid cells{.origin_m = Eigen::Vector3d::Constant(-1), .side_m = 2};
  EXPECT_EQ(pieces_in_cells(mesh, cells).count, 2u);
}

// Two pieces of four faces each, halves of the octahedron, with a third that touches the first
// along two arcs: they are split until no edge is run through twice the same way.
TEST(SurfacePieces, AreSplitWhereTheyTouchTwice) {
  const Mesh mesh = octahedron();
  SurfacePieces pieces{.of_triangle = {0, 0, 2, 1, 1, 0, 0, 3}, .count = 4};
  const PiecePolygons polygons = polygons_between(mesh, pieces);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  const std::uint32_t* c = polygons.corners.data();
  for (const std::uint32_t size : polygons.sizes) {
    for (std::uint32_t k = 0; k < size; ++k) edges.emplace_back(c[k], c[(k + 1) % size]);
    c += size;
  }
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(std::unique(edges.begin(), edges.end()), edges.end());
  EXPECT_GT(pieces.count, 4u);
}

// About the rim of an open surface nothing goes all round.
TEST(SurfacePieces, HaveNoPolygonOnARim) {
  Mesh mesh = octahedron();
  mesh.triangles.pop_back();
  SurfacePieces pieces = pieces_in_cells(mesh, {.side_m = 1});
  EXPECT_EQ(polygons_between(mesh, pieces).sizes, std::vector<std::uint32_t>(3, 4));
}

}  // namespace
}  // namespace scan
