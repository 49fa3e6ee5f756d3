// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A triangle mesh: areas, normals, a census of its edges, and random points on it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libscan/core/point_cloud.h"

namespace scan {

using Triangle = std::array<std::uint32_t, 3>;

// `vertices` in metres; `triangles` counter-clockwise as seen from outside. The first 2 * `quads`
// of them are pairs, (a, b, c) and (a, c, d), that make a quad each: files that know polygons get
// it whole. What works on triangles need not know of it.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  std::size_t quads = 0;
  bool empty() const { return triangles.empty(); }
};

// Places on a picture at a triangle's corners: (0, 0) is its top left corner, (1, 1) the bottom
// right one; it repeats beyond.
using TextureCorners = std::array<Eigen::Vector2d, 3>;

// A mesh and how a picture is laid on it; `corners` has one entry per triangle or is empty.
struct TexturedMesh {
  Mesh mesh;
  std::vector<TextureCorners> corners;
};

// Calls `visit` with the corners of each quad, then of each other triangle, counter-clockwise.
template <class Visit>
void for_each_polygon(const Mesh& mesh, Visit&& visit) {
  for (std::size_t q = 0; q < mesh.quads; ++q) {
    const Triangle& first = mesh.triangles[2 * q];
    const std::array<std::uint32_t, 4> corners{first[0], first[1], first[2],
                                               mesh.triangles[2 * q + 1][2]};
    visit(std::span<const std::uint32_t>(corners));
  }
  for (std::size_t t = 2 * mesh.quads; t < mesh.triangles.size(); ++t)
    visit(std::span<const std::uint32_t>(mesh.triangles[t]));
}

// Throws scan::Error (input) for a triangle that names a vertex which is not there, or a vertex
// that is not finite.
void check(const Mesh& mesh);

// Twice the area vector of a triangle, m^2: direction is the outward normal, length twice the area.
Eigen::Vector3d area_vector(const Mesh& mesh, const Triangle& triangle);

double area_m2(const Mesh& mesh);

// Signed volume by the divergence theorem, m^3; meaningful for a closed mesh, positive when its
// triangles face outwards.
double volume_m3(const Mesh& mesh);

// Area-weighted unit normals, one per vertex; (0,0,0) for a vertex without area.
std::vector<Eigen::Vector3d> vertex_normals(const Mesh& mesh);

Mesh transformed(const Pose& a_from_b, const Mesh& mesh_in_b);

// What the edges tell of the topology. `genus` is meaningful if the mesh is closed and manifold
// (`watertight` and no non-manifold vertex); it is the sum over all components.
struct EdgeCensus {
  std::size_t edges = 0;
  std::size_t boundary_edges = 0;         // in one triangle only
  std::size_t non_manifold_edges = 0;     // in three or more
  std::size_t misoriented_edges = 0;      // two triangles that run through it the same way
  std::size_t non_manifold_vertices = 0;  // whose triangles are not all connected by edges there
  std::size_t components = 0;             // of triangles connected by shared vertices
  std::size_t used_vertices = 0;
  long euler_characteristic = 0;
  long genus = 0;
  bool watertight = false;  // closed, every edge in exactly two triangles that agree
};

EdgeCensus edge_census(const Mesh& mesh);

// A point on a mesh: the triangle, the place, and the triangle's unit normal.
struct SurfaceSample {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  std::uint32_t triangle;
};

// `count` points, uniform by area, stratified along the cumulative area so that small counts cover
// the whole mesh. Same seed, same points. Throws scan::Error (input) if the mesh has no area.
std::vector<SurfaceSample> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed);

}  // namespace scan
