// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The tree of Friedman, Bentley and Finkel (ACM TOMS 3, 1977), with the distance to a node's box
// kept axis by axis on the way down (Arya and Mount, DCC 1993).
#include "libscan/search/kd_tree.h"

#include <algorithm>
#include <limits>

#include "libscan/core/parallel.h"
#include "libscan/search/collect.h"
#include "libscan/search/leaf_blocks.h"

namespace scan {
namespace {

using Points = std::span<LocalPoint>;

// Between the two children, on one axis: `low` is the upper end of the left one, `high` the lower
// end of the right one.
struct Split {
  float low, high;
  std::uint32_t axis;
};

std::uint32_t widest_axis(std::span<const LocalPoint> points) {
  std::array<float, 3> low = points[0].at, high = low;
  for (const LocalPoint& point : points)
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point.at[axis]);
      high[axis] = std::max(high[axis], point.at[axis]);
    }
  std::uint32_t widest = 0;
  for (std::uint32_t axis = 1; axis < 3; ++axis)
    if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
  return widest;
}

// Puts the `count` lowest points along the widest axis in front.
Split split(Points points, std::size_t count) {
  const std::uint32_t axis = widest_axis(points);
  const auto below = [axis](const LocalPoint& a, const LocalPoint& b) {
    return a.at[axis] < b.at[axis];
  };
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(points.begin(), middle, points.end(), below);
  return {std::max_element(points.begin(), middle, below)->at[axis], middle->at[axis], axis};
}

}  // namespace

// Leaves are blocks of eight points, all full but the last; a subtree of n leaves has ceil(n / 2)
// of them on its left, so its shape, and the place of each of its n - 1 splits, follow from n: the
// left child's splits come right behind its own, then the right child's.
struct KdTree::Tree {
  struct Subtree {
    std::uint32_t splits;  // place of the first split
    std::uint32_t block;   // first leaf
    std::uint32_t leaves;

    Subtree left() const { return {splits + 1, block, (leaves + 1) / 2}; }
    Subtree right() const {
      const std::uint32_t before = (leaves + 1) / 2;
      return {splits + before, block + before, leaves - before};
    }
  };
  // A subtree to be searched; `gap2`: squared distance from the query to its box on each axis.
  struct Visit {
    Subtree tree;
    std::array<float, 3> gap2;
    float distance2() const { return gap2[0] + gap2[1] + gap2[2]; }
  };
  static constexpr std::uint32_t parallel_leaves = 512;  // below, a task costs more than it saves

  LocalFrame frame;
  std::size_t points = 0;
  std::vector<Split> splits;
  LeafBlocks blocks;

  void build(const Subtree& tree, Points part, std::span<const Eigen::Vector3d> points_m) {
    if (tree.leaves == 1) return blocks.fill(tree.block, part, points_m);
    const std::size_t count = std::size_t{tree.left().leaves} * LeafBlocks::width;
    splits[tree.splits] = split(part, count);
    const auto build_child = [&](std::size_t child) {
      if (child == 0)
        build(tree.left(), part.first(count), points_m);
      else
        build(tree.right(), part.subspan(count), points_m);
    };
    parallel_for(2, build_child, tree.leaves > parallel_leaves ? 1 : 2);
  }

  // The child that the query is nearer to; the other one is put on the stack if it is near enough.
  template <class Collector>
  Subtree nearer_child(const Visit& visit, const Screen<Collector>& screen, Visit*& top) const {
    const Split& split = splits[visit.tree.splits];
    const float at = screen.at()[split.axis];
    const bool go_right = (at - split.low) + (at - split.high) >= 0;
    const float gap = at - (go_right ? split.low : split.high);
    // Written in place, number by number: to copy it whole would make the processor wait for its
    // own stores, for half of the search's time.
    top->gap2 = visit.gap2;
    top->gap2[split.axis] = gap * gap;
    top->tree = go_right ? visit.tree.left() : visit.tree.right();
    if (top->distance2() <= screen.limit2()) ++top;
    return go_right ? visit.tree.right() : visit.tree.left();
  }

  template <class Collector>
  void search(const Eigen::Vector3d& query, Collector& collector) const {
    if (points == 0 || !query.allFinite()) return;
    Screen<Collector> screen(frame, query, collector);
    std::array<Visit, 33> stack;  // one a level, and 2^32 leaves have 32
    Visit* top = stack.data();
    *top++ = {{0, 0, static_cast<std::uint32_t>(blocks.size())}, {0, 0, 0}};
    while (top != stack.data()) {
      Visit visit = *--top;
      if (!(visit.distance2() <= screen.limit2())) continue;
      while (visit.tree.leaves > 1) visit.tree = nearer_child(visit, screen, top);
      blocks.scan(visit.tree.block, screen);
    }
  }
};

KdTree::KdTree(std::span<const Eigen::Vector3d> points) : tree_(std::make_unique<Tree>()) {
  tree_->frame = local_frame(points);
  std::vector<LocalPoint> local = local_points(points, tree_->frame);
  tree_->points = local.size();
  if (local.empty()) return;
  const std::size_t leaves = (local.size() + LeafBlocks::width - 1) / LeafBlocks::width;
  tree_->blocks.resize(leaves);
  tree_->splits.resize(leaves - 1);
  tree_->build({0, 0, static_cast<std::uint32_t>(leaves)}, local, points);
}

KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::size_t KdTree::size() const {
  return tree_->points;
}

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3d& query, double max_distance_m,
                                         std::uint32_t) const {
  NearestCollector collector(max_distance_m);
  tree_->search(query, collector);
  return collector.take();
}

void KdTree::k_nearest(const Eigen::Vector3d& query, std::size_t k,
                       std::vector<Neighbour>& found) const {
  NearestKCollector collector(k, found);
  tree_->search(query, collector);
  collector.finish();
}

void KdTree::within(const Eigen::Vector3d& query, double radius_m,
                    std::vector<Neighbour>& found) const {
  WithinCollector collector(radius_m, found);
  tree_->search(query, collector);
  collector.finish();
}

}  // namespace scan
