// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/split_triangles.h"

#include <gtest/gtest.h>

namespace scan {
namespace {

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// All 64 choices of edges: each keeps the surface closed, facing outwards, and of the same area.
TEST(SplitTriangles, KeepTheSurface) {
  const Mesh mesh = tetrahedron();
  const MeshEdge edges[6] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (int chosen = 0; chosen < 64; ++chosen) {
    SCOPED_TRACE(chosen);
    EdgePlaces places;
    for (int e = 0; e < 6; ++e)
      if (chosen >> e & 1)
        places[edges[e]] = 0.3 * mesh.vertices[edges[e][0]] + 0.7 * mesh.vertices[edges[e][1]];
    std::map<std::uint32_t, Eigen::Vector3d> inside;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Triangle& t = mesh.triangles[i];
      if (places.contains(mesh_edge(t[0], t[1])) && places.contains(mesh_edge(t[1], t[2])) &&
          places.contains(mesh_edge(t[2], t[0])))
        inside[i] = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    }
    const SplitMesh split = split_triangles(mesh, places, inside);
    const EdgeCensus census = edge_census(split.mesh);
    EXPECT_TRUE(census.watertight);
    EXPECT_EQ(census.genus, 0);
    EXPECT_EQ(split.mesh.vertices.size(), 4 + places.size() + inside.size());
    EXPECT_EQ(split.new_between.size(), places.size() + inside.size());
    EXPECT_NEAR(volume_m3(split.mesh), 1.0 / 6, 1e-15);
    EXPECT_NEAR(area_m2(split.mesh), area_m2(mesh), 1e-15);
  }
}

}  // namespace
}  // namespace scan
