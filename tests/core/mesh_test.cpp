// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Areas, volumes and topology of meshes that are known in closed form.
#include "libscan/core/mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "tests/core/meshes.h"

namespace scan {
namespace {

TEST(Area, OfKnownSolids) {
  EXPECT_NEAR(area_m2(tetrahedron()), 1.5 + std::sqrt(3) / 2, 1e-15);
  EXPECT_DOUBLE_EQ(area_m2(cube(2)), 24);
  EXPECT_EQ(area_m2(Mesh{}), 0);
}

TEST(Volume, OfKnownSolids) {
  EXPECT_NEAR(volume_m3(tetrahedron()), 1.0 / 6, 1e-16);
  EXPECT_DOUBLE_EQ(volume_m3(cube(2)), 8);
  Mesh inverted = cube(2);
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  EXPECT_DOUBLE_EQ(volume_m3(inverted), -8);
}

// The inscribed polygons lose a fraction of about (2 pi / n)^2 / 6 of each circle's area.
TEST(Volume, OfATorusApproachesPappus) {
  const double pi = std::numbers::pi;
  const double expected = 2 * pi * 3 * pi * 1 * 1;
  const double lost = std::pow(2 * pi / 100, 2) / 3;
  EXPECT_NEAR(volume_m3(torus(3, 1, 100, 100)) / expected, 1, 1.1 * lost);
}

// Coordinates of 1e6 round at 1e-10; products with areas of 1 keep that.
TEST(Volume, IsAccurateFarFromTheOrigin) {
  const Pose far = make_pose(Eigen::Matrix3d::Identity(), {1e6, -2e6, 3e6});
  EXPECT_NEAR(volume_m3(transformed(far, cube(1))), 1, 1e-9);
}

TEST(EdgeCensus, OfASphereLikeSolid) {
  for (const Mesh& mesh : {tetrahedron(), cube(1)}) {
    const EdgeCensus census = edge_census(mesh);
    EXPECT_TRUE(census.watertight);
    EXPECT_EQ(census.genus, 0);
    EXPECT_EQ(census.components, 1u);
    EXPECT_EQ(census.euler_characteristic, 2);
    EXPECT_EQ(census.non_manifold_vertices, 0u);
  }
  EXPECT_EQ(edge_census(cube(1)).edges, 18u);
}

TEST(EdgeCensus, OfATorusHasGenusOne) {
  const EdgeCensus census = edge_census(torus(3, 1, 12, 8));
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.genus, 1);
  EXPECT_EQ(census.euler_characteristic, 0);
}

Mesh together(Mesh a, const Mesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles)
    a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

TEST(EdgeCensus, SumsTheGenusOverComponents) {
  const EdgeCensus census =
      edge_census(together(torus(3, 1, 12, 8), together(cube(1), torus(9, 1, 6, 5))));
  EXPECT_EQ(census.components, 3u);
  EXPECT_EQ(census.genus, 2);
}

TEST(EdgeCensus, CountsTheBoundaryOfAnOpenMesh) {
  Mesh open = cube(1);
  open.triangles.resize(10);  // without the face x = 1
  const EdgeCensus census = edge_census(open);
  EXPECT_EQ(census.boundary_edges, 4u);
  EXPECT_FALSE(census.watertight);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
}

TEST(EdgeCensus, SeesThreeTrianglesOnAnEdge) {
  const Mesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                 {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const EdgeCensus census = edge_census(fan);
  EXPECT_EQ(census.non_manifold_edges, 1u);
  EXPECT_EQ(census.boundary_edges, 6u);
  EXPECT_FALSE(census.watertight);
}

TEST(EdgeCensus, SeesATriangleTurnedOver) {
  Mesh mesh = tetrahedron();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_EQ(edge_census(mesh).misoriented_edges, 3u);
  EXPECT_FALSE(edge_census(mesh).watertight);
}

TEST(EdgeCensus, SeesTwoSolidsThatShareAVertex) {
  Mesh mesh = together(tetrahedron(), transformed(make_pose(-Eigen::Matrix3d::Identity(), {0, 0, 0}),
                                                  tetrahedron()));
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = v == 4 ? 0 : v;
  EXPECT_EQ(edge_census(mesh).non_manifold_vertices, 1u);
}

TEST(EdgeCensus, IgnoresVerticesThatNobodyUses) {
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back({9, 9, 9});
  EXPECT_EQ(edge_census(mesh).used_vertices, 4u);
  EXPECT_EQ(edge_census(mesh).components, 1u);
  EXPECT_EQ(edge_census(mesh).genus, 0);
}

TEST(Check, NamesTheBrokenTriangle) {
  Mesh mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  EXPECT_THROW(check(mesh), Error);
  mesh = tetrahedron();
  mesh.vertices[1].x() = std::nan("");
  EXPECT_THROW(check(mesh), Error);
  EXPECT_NO_THROW(check(tetrahedron()));
}

TEST(VertexNormals, PointOutwardsAndHaveUnitLength) {
  const Mesh mesh = torus(3, 1, 40, 40);
  const auto normals = vertex_normals(mesh);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3d& x = mesh.vertices[i];
    const Eigen::Vector3d ring = 3 * Eigen::Vector3d(x.x(), x.y(), 0).normalized();
    EXPECT_NEAR(normals[i].norm(), 1, 1e-14);
    // facets turn by 2 pi / 40 from one to the next, a vertex normal is off by less
    EXPECT_GT(normals[i].dot(x - ring), std::cos(2 * std::numbers::pi / 40));
  }
}

// 12 cells, one per triangle of the cube of equal areas, and 4 sub-triangles of each (joined edge
// middles): 48 equal cells. Chi-square with 47 degrees of freedom is above 114 with probability
// 2e-7; stratification along the area can only lower it.
TEST(SampleSurface, IsUniformByArea) {
  constexpr std::size_t count = 48'000;
  const Mesh mesh = cube(1);
  std::vector<double> cells(48, 0);
  for (const SurfaceSample& sample : sample_surface(mesh, count, 5)) {
    const Triangle& t = mesh.triangles[sample.triangle];
    const Eigen::Vector3d area = area_vector(mesh, t);
    std::size_t part = 3;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d b = mesh.vertices[t[(k + 1) % 3]] - sample.point;
      const Eigen::Vector3d c = mesh.vertices[t[(k + 2) % 3]] - sample.point;
      if (b.cross(c).dot(area) > area.squaredNorm() / 2) part = k;
    }
    cells[4 * sample.triangle + part] += 1;
    EXPECT_NEAR(area.normalized().dot(sample.point - mesh.vertices[t[0]]), 0, 1e-15);
    EXPECT_LT((sample.normal - area.normalized()).norm(), 1e-15);
  }
  double chi2 = 0;
  for (const double cell : cells) chi2 += (cell - 1000) * (cell - 1000) / 1000;
  EXPECT_LT(chi2, 114);
  EXPECT_GT(chi2, 5);  // far below would mean a regular pattern instead of chance within triangles
}

TEST(SampleSurface, RefusesAMeshWithoutArea) {
  EXPECT_THROW(sample_surface(Mesh{}, 10, 1), Error);
}

}  // namespace
}  // namespace scan
