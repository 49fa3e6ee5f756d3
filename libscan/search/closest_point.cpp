// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
#include "libscan/search/triangle_tree.h"

namespace scan {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

Eigen::Vector3d closest_point_on_segment(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double along = ab.dot(x - a);
  if (!(along > 0) || !(length2 > 0)) return a;
  if (along >= length2) return b;
  return a + (along / length2) * ab;
}

Eigen::Vector3d closest_point_on_edges(const Eigen::Vector3d& x, const Corners& corners) {
  Eigen::Vector3d best = closest_point_on_segment(x, corners[0], corners[1]);
  for (int i = 1; i < 3; ++i) {
    const Eigen::Vector3d other = closest_point_on_segment(x, corners[i], corners[(i + 1) % 3]);
    if ((other - x).squaredNorm() < (best - x).squaredNorm()) best = other;
  }
  return best;
}

// The foot of the perpendicular from x, if it is inside the triangle. The share of c is known to
// rounding / height only; to find the place along ab by projection after that, and not by a share
// of its own, keeps the foot right to rounding however thin the triangle.
std::optional<Eigen::Vector3d> foot_inside(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ax = x - a, normal = ab.cross(ac);
  const double normal2 = normal.squaredNorm();
  if (!(normal2 > 0)) return std::nullopt;
  const double of_c = ab.cross(ax).dot(normal) / normal2;
  if (!(of_c >= 0 && of_c <= 1)) return std::nullopt;
  const double of_b = (ax - of_c * ac).dot(ab) / ab.squaredNorm();
  if (!(of_b >= 0 && of_b + of_c <= 1)) return std::nullopt;
  return a + of_c * ac + of_b * ab;
}

}  // namespace

// Either the foot of the perpendicular is inside, or the nearest point is on an edge.
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const std::optional<Eigen::Vector3d> foot = foot_inside(x, a, b, c);
  return foot ? *foot : closest_point_on_edges(x, {a, b, c});
}

struct MeshSearch::Tree : TriangleTree {
  using TriangleTree::TriangleTree;
};

namespace {

// Neighbours along the curve lie anywhere in memory, which takes as long as a search: they are
// fetched so many searches ahead (8 and 16 are alike).
constexpr std::size_t fetched_ahead = 8;

const Mesh& searchable(const Mesh& mesh) {
  check(mesh);
  if (mesh.triangles.empty()) throw Error(Trouble::input, "mesh search: the mesh has no triangles");
  return mesh;
}

}  // namespace

MeshSearch::MeshSearch(const Mesh& mesh) : tree_(std::make_unique<Tree>(searchable(mesh))) {}

MeshSearch::~MeshSearch() = default;
MeshSearch::MeshSearch(MeshSearch&&) noexcept = default;
MeshSearch& MeshSearch::operator=(MeshSearch&&) noexcept = default;

ClosestPoint MeshSearch::closest(const Eigen::Vector3d& query, std::uint32_t guess) const {
  const TriangleTree::Best best = tree_->nearest(query, guess);
  return {best.point, best.triangle, std::sqrt(best.distance2_m2)};
}

std::vector<ClosestPoint> closest_of_each(const MeshSearch& search,
                                          std::span<const Eigen::Vector3d> queries) {
  const std::vector<std::uint32_t> order = curve_order(queries);
  std::vector<ClosestPoint> found(queries.size());
  parallel_chunks(queries.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
    std::uint32_t guess = no_triangle;
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t i = order[place];
      if (place + fetched_ahead < end) {
        __builtin_prefetch(&queries[order[place + fetched_ahead]]);
        __builtin_prefetch(&found[order[place + fetched_ahead]], 1);
      }
      if (queries[i].allFinite())
        found[i] = search.closest(queries[i], guess);
      else
        found[i] = {queries[i], no_triangle, std::numeric_limits<double>::infinity()};
      guess = found[i].triangle;
    }
  });
  return found;
}

}  // namespace scan
