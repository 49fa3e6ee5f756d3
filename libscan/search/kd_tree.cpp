// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The tree of Friedman, Bentley and Finkel (ACM TOMS 3, 1977), three of its binary levels to a
// node, laid out level by level.
#include "libscan/search/kd_tree.h"

#include <algorithm>

#include "libscan/core/parallel.h"
#include "libscan/search/box_tree.h"

namespace scan {
namespace {

using Points = std::span<LocalPoint>;

constexpr std::size_t parallel_points = 8192;  // below, a task costs more than it saves

unsigned widest_axis(const TreeBox& box) {
  unsigned widest = 0;
  for (unsigned axis = 1; axis < 3; ++axis)
    if (box.high[axis] - box.low[axis] > box.high[widest] - box.low[widest]) widest = axis;
  return widest;
}

// All leaves but the last are full, all nodes but the last of each level have eight children. So
// the place of each follows from its level (0: the leaves) and its number there.
class Builder {
 public:
  Builder(BoxTree& tree, std::span<const Eigen::Vector3d> points_m)
      : tree_(tree), points_m_(points_m) {}

  void build(Points points) {
    counts_ = {static_cast<std::uint32_t>((points.size() + leaf_width - 1) / leaf_width)};
    while (counts_.back() > 1) counts_.push_back((counts_.back() + node_width - 1) / node_width);
    firsts_.assign(counts_.size(), 0);
    for (std::size_t level = counts_.size() - 1; level > 1; --level)
      firsts_[level - 1] = firsts_[level] + counts_[level];
    tree_.resize(counts_[0]);
    tree_.nodes.resize(counts_.size() > 1 ? firsts_[1] + counts_[1] : 0);
    tree_.root = child(counts_.size() - 1, 0);
    fill(counts_.size() - 1, 0, points, TreeBox(points));
  }

 private:
  // Some children of a node in consecutive lanes of a part of it, and the plane that halves it.
  struct Part {
    TreeNode& node;
    std::array<unsigned char, node_width - 1>& axes;  // of its planes, each written by one task
    std::size_t level;                                // of the children
    std::uint32_t first, count;
    unsigned lane, width, plane;
  };

  std::uint32_t child(std::size_t level, std::uint32_t number) const {
    return level == 0 ? leaf_bit | number : firsts_[level] + number;
  }
  std::size_t points_below(std::size_t level) const {
    return std::size_t{leaf_width} << (3 * level);
  }

  void fill(std::size_t level, std::uint32_t number, Points points, const TreeBox& box) {
    if (level == 0) return tree_.fill(number, points, points_m_);
    TreeNode& node = tree_.nodes[child(level, number)];
    node = empty_node();
    std::array<unsigned char, node_width - 1> axes{};
    const std::uint32_t first = number * node_width;
    const std::uint32_t count = std::min<std::uint32_t>(node_width, counts_[level - 1] - first);
    fill_part({node, axes, level - 1, first, count, 0, node_width, 0}, points, box);
    for (unsigned plane = 0; plane < axes.size(); ++plane) node.axes |= axes[plane] << (2 * plane);
  }

  void fill_part(const Part& part, Points points, const TreeBox& box) {
    if (part.count == 1) {
      set_child(part.node, part.lane, child(part.level, part.first), box);
      return fill(part.level, part.first, points, box);
    }
    const std::uint32_t below = (part.count + 1) / 2;
    const unsigned axis = widest_axis(box), half = part.width / 2;
    const std::size_t middle = below * points_below(part.level);
    std::nth_element(
        points.begin(), points.begin() + static_cast<std::ptrdiff_t>(middle), points.end(),
        [axis](const LocalPoint& a, const LocalPoint& b) { return a.at[axis] < b.at[axis]; });
    const Points halves[2] = {points.first(middle), points.subspan(middle)};
    const TreeBox boxes[2] = {TreeBox(halves[0]), TreeBox(halves[1])};
    part.node.plane[part.plane] = boxes[1].low[axis];
    part.axes[part.plane] = static_cast<unsigned char>(axis);
    const Part parts[2] = {
        {part.node, part.axes, part.level, part.first, below, part.lane, half, 2 * part.plane + 1},
        {part.node, part.axes, part.level, part.first + below, part.count - below, part.lane + half,
         half, 2 * part.plane + 2}};
    parallel_for(
        2, [&](std::size_t i) { fill_part(parts[i], halves[i], boxes[i]); },
        points.size() > parallel_points ? 1 : 2);
  }

  BoxTree& tree_;
  std::span<const Eigen::Vector3d> points_m_;
  std::vector<std::uint32_t> counts_, firsts_;  // of the nodes of each level
};

}  // namespace

BoxTree build_kd_tree(std::span<const Eigen::Vector3d> points_m) {
  BoxTree tree = empty_tree(points_m);
  LargeArray<LocalPoint> local = local_points(points_m, tree.frame);
  tree.points = local.size();
  if (!local.empty()) Builder(tree, points_m).build(local);
  return tree;
}

KdTree::KdTree(std::span<const Eigen::Vector3d> points) : BoxSearch(build_kd_tree(points)) {}

}  // namespace scan
