// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/split_triangles.h"

namespace scan {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

// Corners and the vertices on the edges after them, turned so that the pattern starts at 0.
struct Split {
  Triangle corner;
  Triangle on_edge;
  void turn() {
    std::rotate(corner.begin(), corner.begin() + 1, corner.end());
    std::rotate(on_edge.begin(), on_edge.begin() + 1, on_edge.end());
  }
};

// Two vertices on the edges that meet at corner 1: its tip, and a quad along the shorter diagonal.
void cut_tip(const Split& s, Mesh& mesh) {
  const std::uint32_t a = s.corner[0], b = s.corner[1], c = s.corner[2], p = s.on_edge[0],
                      q = s.on_edge[1];
  mesh.triangles.push_back({p, b, q});
  const auto length2 = [&](std::uint32_t i, std::uint32_t j) {
    return (mesh.vertices[i] - mesh.vertices[j]).squaredNorm();
  };
  if (length2(a, q) < length2(p, c)) {
    mesh.triangles.push_back({a, p, q});
    mesh.triangles.push_back({a, q, c});
  } else {
    mesh.triangles.push_back({a, p, c});
    mesh.triangles.push_back({p, q, c});
  }
}

void add(Split s, std::uint32_t middle, Mesh& mesh) {
  const auto count = 3 - std::count(s.on_edge.begin(), s.on_edge.end(), none);
  if (count == 0) {
    mesh.triangles.push_back(s.corner);
  } else if (count == 1) {
    while (s.on_edge[0] == none) s.turn();
    mesh.triangles.push_back({s.corner[0], s.on_edge[0], s.corner[2]});
    mesh.triangles.push_back({s.on_edge[0], s.corner[1], s.corner[2]});
  } else if (count == 2) {
    while (s.on_edge[2] != none) s.turn();
    cut_tip(s, mesh);
  } else {
    for (int k = 0; k < 3; ++k) {
      mesh.triangles.push_back({s.corner[k], s.on_edge[k], middle});
      mesh.triangles.push_back({s.on_edge[k], s.corner[(k + 1) % 3], middle});
    }
  }
}

}  // namespace

SplitMesh split_triangles(const Mesh& mesh, const EdgePlaces& on_edges,
                          const std::map<std::uint32_t, Eigen::Vector3d>& inside) {
  SplitMesh split;
  split.mesh.vertices = mesh.vertices;
  std::map<MeshEdge, std::uint32_t> vertex_on;
  const auto put = [&](const Eigen::Vector3d& place, const MeshEdge& between) {
    split.mesh.vertices.push_back(place);
    split.new_between.push_back(between);
    return static_cast<std::uint32_t>(split.mesh.vertices.size() - 1);
  };
  for (const auto& [edge, place] : on_edges) vertex_on[edge] = put(place, edge);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    Split s{t, {none, none, none}};
    for (int k = 0; k < 3; ++k)
      if (const auto at = vertex_on.find(mesh_edge(t[k], t[(k + 1) % 3])); at != vertex_on.end())
        s.on_edge[k] = at->second;
    const auto middle = inside.find(i);
    add(s, middle == inside.end() ? none : put(middle->second, mesh_edge(t[0], t[1])), split.mesh);
  }
  return split;
}

}  // namespace scan
