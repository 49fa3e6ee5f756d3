// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_pieces.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/disjoint_sets.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

// The triangle across each edge, edge k from corner k to the next; `none` on a rim.
std::vector<std::uint32_t> triangles_across(const Mesh& mesh) {
  struct Side {
    std::uint64_t edge;  // its ends, the lower first
    std::uint32_t slot;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b) << 32 | std::max(a, b), 3 * t + k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.slot < b.slot;
  });
  std::vector<std::uint32_t> across(sides.size(), none);
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].edge == sides[i - 1].edge) {
      across[sides[i].slot] = sides[i - 1].slot / 3;
      across[sides[i - 1].slot] = sides[i].slot / 3;
    }
  return across;
}

// Numbered in the order of their first triangles.
SurfacePieces numbered(DisjointSets sets) {
  SurfacePieces pieces;
  pieces.of_triangle.resize(sets.size());
  for (std::uint32_t t = 0; t < sets.size(); ++t) {
    const std::uint32_t root = sets.name_of(t);
    pieces.of_triangle[t] = root == t ? pieces.count++ : pieces.of_triangle[root];
  }
  return pieces;
}

class PolygonFinder {
 public:
  PolygonFinder(const Mesh& mesh, SurfacePieces& pieces)
      : mesh_(mesh),
        pieces_(pieces),
        across_(triangles_across(mesh)),
        triangle_at_(mesh.vertices.size(), none) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t])
        if (triangle_at_[v] == none) triangle_at_[v] = t;
  }

  PiecePolygons run() {
    do {
      polygons_ = {};
      for (std::uint32_t v = 0; v < triangle_at_.size(); ++v)
        if (triangle_at_[v] != none) add_polygon(v);
    } while (split_what_touches_twice());
    return std::move(polygons_);
  }

 private:
  // The pieces about a vertex, each run of its triangles once; empty on a rim.
  void pieces_about(std::uint32_t vertex, std::vector<std::uint32_t>& around) const {
    around.clear();
    std::uint32_t t = triangle_at_[vertex];
    do {
      const std::uint32_t piece = pieces_.of_triangle[t];
      if (around.empty() || around.back() != piece) around.push_back(piece);
      const Triangle& corners = mesh_.triangles[t];
      const auto at = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
      t = across_[std::size_t{3} * t + std::size_t(at + 2) % 3];
      if (t == none) return around.clear();
    } while (t != triangle_at_[vertex]);
    if (around.size() > 1 && around.front() == around.back()) around.pop_back();
  }

  void add_polygon(std::uint32_t vertex) {
    pieces_about(vertex, around_);
    if (around_.size() < 3) return;
    polygons_.corners.insert(polygons_.corners.end(), around_.begin(), around_.end());
    polygons_.sizes.push_back(static_cast<std::uint32_t>(around_.size()));
  }

  // Pieces on both sides of an edge that two polygons run through the same way, and pieces that
  // stand in a polygon twice.
  std::vector<std::uint32_t> touching_twice() const {
    std::vector<std::uint32_t> found;
    std::vector<std::uint64_t> edges;
    edges.reserve(polygons_.corners.size());
    const std::uint32_t* corner = polygons_.corners.data();
    for (const std::uint32_t size : polygons_.sizes) {
      for (std::uint32_t k = 0; k < size; ++k) {
        edges.push_back(std::uint64_t{corner[k]} << 32 | corner[(k + 1) % size]);
        if (std::count(corner, corner + size, corner[k]) > 1) found.push_back(corner[k]);
      }
      corner += size;
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 1; i < edges.size(); ++i)
      if (edges[i] == edges[i - 1])
        for (const std::uint64_t piece : {edges[i] >> 32, edges[i] & none})
          found.push_back(static_cast<std::uint32_t>(piece));
    return found;
  }

  bool split_what_touches_twice() {
    std::vector<std::uint32_t> triangles(pieces_.count, 0);
    for (const std::uint32_t piece : pieces_.of_triangle) ++triangles[piece];
    std::vector<char> is_split(pieces_.count, 0);
    for (const std::uint32_t piece : touching_twice()) is_split[piece] = triangles[piece] > 1;
    if (std::count(is_split.begin(), is_split.end(), 1) == 0) return false;
    for (std::uint32_t& piece : pieces_.of_triangle)
      if (is_split[piece] && --triangles[piece] > 0) piece = pieces_.count++;
    return true;
  }

  const Mesh& mesh_;
  SurfacePieces& pieces_;
  std::vector<std::uint32_t> across_, triangle_at_, around_;
  PiecePolygons polygons_;
};

}  // namespace

SurfacePieces pieces_in_cells(const Mesh& mesh, const CellGrid& cells) {
  std::vector<std::array<std::int64_t, 3>> places(mesh.triangles.size());
  parallel_for(places.size(), [&](std::size_t i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : mesh.triangles[i]) sum += mesh.vertices[v] - cells.origin_m;
    for (int a = 0; a < 3; ++a)
      places[i][a] = static_cast<std::int64_t>(std::floor(sum[a] / (3 * cells.side_m)));
  });
  const std::vector<std::uint32_t> across = triangles_across(mesh);
  DisjointSets sets(places.size());
  for (std::uint32_t slot = 0; slot < across.size(); ++slot) {
    const std::uint32_t other = across[slot];
    if (other != none && places[other] == places[slot / 3]) sets.unite(slot / 3, other);
  }
  return numbered(std::move(sets));
}

PiecePolygons polygons_between(const Mesh& mesh, SurfacePieces& pieces) {
  return PolygonFinder(mesh, pieces).run();
}

}  // namespace scan
