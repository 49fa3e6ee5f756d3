// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/kd_tree.h"

#include <algorithm>
#include <Eigen/Geometry>

namespace scan {

// Nodes split the widest axis at the median; leaves hold up to `leaf_size` consecutive points.
struct KdTree::Tree {
  static constexpr std::uint32_t leaf_size = 12;
  struct Node {
    std::uint32_t begin = 0, end = 0;  // points of the leaf
    std::uint32_t right = 0;           // index of the right child; the left one follows; 0: leaf
    int axis = 0;
    double split = 0;
  };
  std::vector<Eigen::Vector3d> points;  // in leaf order
  std::vector<std::uint32_t> index;     // original index of each
  std::vector<Node> nodes;

  void build(std::span<const Eigen::Vector3d> all, std::uint32_t begin, std::uint32_t end) {
    const auto self = nodes.size();
    nodes.push_back({begin, end, 0, 0, 0});
    if (end - begin <= leaf_size) return;
    Eigen::AlignedBox3d box;
    for (std::uint32_t i = begin; i < end; ++i) box.extend(all[index[i]]);
    Eigen::Index axis;
    if (!(box.sizes().maxCoeff(&axis) > 0)) return;  // all the same point
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(index.begin() + begin, index.begin() + middle, index.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) { return all[a][axis] < all[b][axis]; });
    nodes[self].axis = static_cast<int>(axis);
    nodes[self].split = all[index[middle]][axis];
    build(all, begin, middle);
    nodes[self].right = static_cast<std::uint32_t>(nodes.size());
    build(all, middle, end);
  }

  // Calls visit(index, distance2) for the points of each leaf that may hold one within `limit2`
  // (read anew each time, so that visit may shrink it).
  template <class Visit>
  void search(std::size_t node_index, const Eigen::Vector3d& query, double& limit2,
              Visit&& visit) const {
    const Node& node = nodes[node_index];
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        visit(index[i], (points[i] - query).squaredNorm());
      return;
    }
    const double gap = query[node.axis] - node.split;
    const std::size_t near = gap < 0 ? node_index + 1 : node.right;
    const std::size_t far = gap < 0 ? node.right : node_index + 1;
    search(near, query, limit2, visit);
    if (gap * gap <= limit2) search(far, query, limit2, visit);
  }
};

KdTree::KdTree(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>()) {
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) tree_->index.push_back(i);
  tree_->build(points, 0, static_cast<std::uint32_t>(tree_->index.size()));
  for (const std::uint32_t i : tree_->index) tree_->points.push_back(points[i]);
}

KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::size_t KdTree::size() const { return tree_->index.size(); }

namespace {
bool before(const Neighbour& a, const Neighbour& b) {
  return a.distance2_m2 < b.distance2_m2 ||
         (a.distance2_m2 == b.distance2_m2 && a.index < b.index);
}
}  // namespace

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3d& query,
                                         double max_distance_m) const {
  std::optional<Neighbour> best;
  double limit2 = max_distance_m * max_distance_m;
  tree_->search(0, query, limit2, [&](std::uint32_t index, double distance2) {
    const Neighbour candidate{index, distance2};
    if (distance2 > limit2 || (best && !before(candidate, *best))) return;
    best = candidate;
    limit2 = distance2;
  });
  return best;
}

void KdTree::k_nearest(const Eigen::Vector3d& query, std::size_t k,
                       std::vector<Neighbour>& found) const {
  found.clear();
  if (k == 0) return;
  double limit2 = unlimited_m;
  tree_->search(0, query, limit2, [&](std::uint32_t index, double distance2) {
    const Neighbour candidate{index, distance2};
    if (found.size() == k && !before(candidate, found.front())) return;
    if (found.size() == k) {
      std::pop_heap(found.begin(), found.end(), before);
      found.pop_back();
    }
    found.push_back(candidate);
    std::push_heap(found.begin(), found.end(), before);
    if (found.size() == k) limit2 = found.front().distance2_m2;
  });
  std::sort_heap(found.begin(), found.end(), before);
}

void KdTree::within(const Eigen::Vector3d& query, double radius_m,
                    std::vector<Neighbour>& found) const {
  found.clear();
  double limit2 = radius_m * radius_m;
  tree_->search(0, query, limit2, [&](std::uint32_t index, double distance2) {
    if (distance2 <= limit2) found.push_back({index, distance2});
  });
  std::sort(found.begin(), found.end(), before);
}

}  // namespace scan
