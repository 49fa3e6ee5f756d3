// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/slivers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "libscan/reconstruct/collapsing_mesh.h"

namespace scan {
namespace {

constexpr int most_passes = 10;  // one mend may make room for the next

// The sides of a triangle, corner k to corner k + 1.
struct Sides {
  int shortest = 0, longest = 0;
  double shortest_m = 0, longest_m = 0, height_m = 0;  // over the longest
};

template <class At>
Sides sides_of(const Triangle& t, At at) {
  std::array<double, 3> length;
  for (int k = 0; k < 3; ++k) length[k] = (at(t[k]) - at(t[(k + 1) % 3])).norm();
  const auto [low, high] = std::minmax_element(length.begin(), length.end());
  const double twice_area = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm();
  return {static_cast<int>(low - length.begin()), static_cast<int>(high - length.begin()), *low,
          *high, *high > 0 ? twice_area / *high : 0};
}

bool is_sliver(const Sides& sides) {
  return sides.height_m <= sliver_height * sides.longest_m;
}

bool mend(CollapsingMesh& mesh, std::uint32_t triangle) {
  const Triangle t = mesh.triangle(triangle);
  const Sides sides = sides_of(t, [&](std::uint32_t v) { return mesh.at(v); });
  if (!is_sliver(sides)) return false;
  if (sides.shortest_m <= 2 * sliver_height * sides.longest_m) {
    const auto [gone, kept] = std::minmax(t[sides.shortest], t[(sides.shortest + 1) % 3]);
    for (const auto& [stays, goes] : {std::pair(kept, gone), std::pair(gone, kept)})
      if (mesh.may_collapse(stays, goes, mesh.at(stays))) {
        mesh.collapse(stays, goes, mesh.at(stays));
        return true;
      }
  }
  const std::uint32_t a = t[sides.longest], b = t[(sides.longest + 1) % 3];
  if (!mesh.may_flip(a, b)) return false;
  mesh.flip(a, b);
  return true;
}

}  // namespace

Mesh without_slivers(const Mesh& mesh, std::span<const char> marked,
                     std::vector<std::uint32_t>& vertex_of) {
  std::vector<std::uint32_t> slivers;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if ((marked[t[0]] || marked[t[1]] || marked[t[2]]) &&
        is_sliver(sides_of(t, [&](std::uint32_t v) { return mesh.vertices[v]; })))
      slivers.push_back(i);
  }
  vertex_of.resize(mesh.vertices.size());
  std::iota(vertex_of.begin(), vertex_of.end(), 0);
  if (slivers.empty()) return mesh;
  CollapsingMesh mended(mesh);
  for (int pass = 0; pass < most_passes; ++pass) {
    bool changed = false;
    for (const std::uint32_t t : slivers) changed |= mended.is_alive(t) && mend(mended, t);
    if (!changed) break;
  }
  return mended.mesh(vertex_of);
}

}  // namespace scan
