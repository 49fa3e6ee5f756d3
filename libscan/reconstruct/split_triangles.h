// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Triangles split where given places on their edges and inside them ask for it.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

using MeshEdge = std::array<std::uint32_t, 2>;  // ascending
inline MeshEdge mesh_edge(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}
using EdgePlaces = std::map<MeshEdge, Eigen::Vector3d>;

struct SplitMesh {
  Mesh mesh;                          // the old vertices first
  std::vector<MeshEdge> new_between;  // old vertices that each new one was put between
};

// Each named edge gets a vertex, in all its triangles; a triangle with three gets one inside too,
// at `inside` (by its index, which must name all of these). A manifold stays one.
SplitMesh split_triangles(const Mesh& mesh, const EdgePlaces& on_edges,
                          const std::map<std::uint32_t, Eigen::Vector3d>& inside);

}  // namespace scan
