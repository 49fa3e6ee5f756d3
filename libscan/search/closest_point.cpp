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

// Without branches, which nobody could predict.
double squared_distance_m2(const Bounds& box, const Eigen::Vector3d& x) {
  return (box.min() - x).cwiseMax(x - box.max()).cwiseMax(0).squaredNorm();
}

}  // namespace

// Either the foot of the perpendicular is inside, or the nearest point is on an edge.
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const std::optional<Eigen::Vector3d> foot = foot_inside(x, a, b, c);
  return foot ? *foot : closest_point_on_edges(x, {a, b, c});
}

// Leaves hold up to `leaf_size` triangles; inner nodes split the widest axis of the triangles'
// centres at their median, so the shape of the tree depends on their number only.
struct MeshSearch::Tree {
  static constexpr std::uint32_t leaf_size = 4;
  struct Node {
    Bounds box;
    std::uint32_t begin = 0, end = 0;  // triangles of the subtree
    std::uint32_t right = 0;           // the left child follows its parent; 0: a leaf
  };
  std::vector<Corners> corners;           // of the triangles, in leaf order
  std::vector<std::uint32_t> index;       // original index of each
  std::vector<std::uint32_t> leaf_place;  // of each original index
  std::vector<Node> nodes;

  static std::uint32_t middle_of(std::uint32_t begin, std::uint32_t end) {
    return begin + (end - begin) / 2;
  }

  static std::uint32_t node_count(std::uint32_t triangles) {
    if (triangles <= leaf_size) return 1;
    const std::uint32_t left = middle_of(0, triangles);
    return 1 + node_count(left) + node_count(triangles - left);
  }

  void split(const std::vector<Eigen::Vector3d>& centres, std::uint32_t begin, std::uint32_t end) {
    Bounds box;
    for (std::uint32_t i = begin; i < end; ++i) box.extend(centres[index[i]]);
    Eigen::Index axis;
    box.sizes().maxCoeff(&axis);
    std::nth_element(index.begin() + begin, index.begin() + middle_of(begin, end),
                     index.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
                       const double ca = centres[a][axis], cb = centres[b][axis];
                       return ca < cb || (ca == cb && a < b);
                     });
  }

  void build(const Mesh& mesh, const std::vector<Eigen::Vector3d>& centres, std::uint32_t self,
             std::uint32_t begin, std::uint32_t end) {
    Node& node = nodes[self];
    node.begin = begin;
    node.end = end;
    if (end - begin <= leaf_size) {
      for (std::uint32_t i = begin; i < end; ++i) {
        for (int j = 0; j < 3; ++j) corners[i][j] = mesh.vertices[mesh.triangles[index[i]][j]];
        for (const auto& corner : corners[i]) node.box.extend(corner);
      }
      return;
    }
    split(centres, begin, end);
    const std::uint32_t middle = middle_of(begin, end);
    node.right = self + 1 + node_count(middle - begin);
    const auto build_child = [&](std::size_t child) {
      if (child == 0)
        build(mesh, centres, self + 1, begin, middle);
      else
        build(mesh, centres, node.right, middle, end);
    };
    parallel_for(2, build_child, end - begin > parallel_size ? 1 : 2);
    node.box = nodes[self + 1].box.merged(nodes[node.right].box);
  }
  static constexpr std::uint32_t parallel_size = 8192;  // below, a task costs more than it saves

  // The rounding of a point computed inside a box moves it out by a few units in the last place of
  // the largest coordinate; all boxes are widened by more than that, so that no triangle whose
  // computed distance ties with or beats another's is passed by.
  void widen_boxes() {
    const Bounds& all = nodes.front().box;
    const double largest = all.min().cwiseAbs().cwiseMax(all.max().cwiseAbs()).maxCoeff();
    const Eigen::Vector3d margin =
        Eigen::Vector3d::Constant(16 * std::numeric_limits<double>::epsilon() * largest);
    for (Node& node : nodes) node.box = Bounds(node.box.min() - margin, node.box.max() + margin);
  }

  struct Best {
    double distance2_m2 = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };

  void search_triangle(std::uint32_t i, const Eigen::Vector3d& query, Best& best) const {
    const auto& [a, b, c] = corners[i];
    const Eigen::Vector3d point = closest_point_on_triangle(query, a, b, c);
    const double distance2 = (point - query).squaredNorm();
    const bool tie = distance2 == best.distance2_m2 && index[i] < best.triangle;
    if (distance2 < best.distance2_m2 || tie) best = {distance2, index[i], point};
  }

  void search_leaf(const Node& node, const Eigen::Vector3d& query, Best& best) const {
    for (std::uint32_t i = node.begin; i < node.end; ++i) search_triangle(i, query, best);
  }

  void search(std::uint32_t self, const Eigen::Vector3d& query, Best& best) const {
    const Node& node = nodes[self];
    if (node.right == 0) return search_leaf(node, query, best);
    std::uint32_t near = self + 1, far = node.right;
    double near2 = squared_distance_m2(nodes[near].box, query);
    double far2 = squared_distance_m2(nodes[far].box, query);
    if (far2 < near2) {
      std::swap(near, far);
      std::swap(near2, far2);
    }
    // 1 + 1e-12: the rounding of the two squared distances that are compared, with room to spare.
    if (near2 <= best.distance2_m2 * (1 + 1e-12)) search(near, query, best);
    if (far2 <= best.distance2_m2 * (1 + 1e-12)) search(far, query, best);
  }
};

MeshSearch::MeshSearch(const Mesh& mesh) : tree_(std::make_unique<Tree>()) {
  check(mesh);
  if (mesh.triangles.empty()) throw Error(Trouble::input, "mesh search: the mesh has no triangles");
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<Eigen::Vector3d> centres(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Bounds box;
    for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.vertices[v]);
    centres[i] = box.center();
  }
  tree_->index.resize(count);
  std::iota(tree_->index.begin(), tree_->index.end(), 0u);
  tree_->corners.resize(count);
  tree_->nodes.resize(Tree::node_count(count));
  tree_->build(mesh, centres, 0, 0, count);
  tree_->leaf_place.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) tree_->leaf_place[tree_->index[i]] = i;
  tree_->widen_boxes();
}

MeshSearch::~MeshSearch() = default;
MeshSearch::MeshSearch(MeshSearch&&) noexcept = default;
MeshSearch& MeshSearch::operator=(MeshSearch&&) noexcept = default;

ClosestPoint MeshSearch::closest(const Eigen::Vector3d& query, std::uint32_t guess) const {
  Tree::Best best;
  if (guess < tree_->leaf_place.size())
    tree_->search_triangle(tree_->leaf_place[guess], query, best);
  tree_->search(0, query, best);
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
