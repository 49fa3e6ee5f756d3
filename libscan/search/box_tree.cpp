// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/box_tree.h"

#include <algorithm>
#include <limits>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr std::size_t most_leaves = (std::size_t{1} << 28) - 1;  // so that a place has 32 bits
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TreeBox::TreeBox(std::span<const LocalPoint> points) : low(points[0].at), high(points[0].at) {
  for (const LocalPoint& point : points)
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], point.at[axis]);
      high[axis] = std::max(high[axis], point.at[axis]);
    }
}

void BoxTree::resize(std::size_t leaf_count) {
  if (leaf_count > most_leaves)
    throw Error(Trouble::resource, "neighbour search: " + std::to_string(points) + " points in " +
                                       std::to_string(leaf_count) + " leaves, must be at most " +
                                       std::to_string(most_leaves));
  leaves.resize(leaf_count);
  records.resize(leaf_count * leaf_width);
}

void BoxTree::fill(std::uint32_t leaf, std::span<const LocalPoint> part,
                   std::span<const Eigen::Vector3d> points_m) {
  for (std::size_t lane = 0; lane < leaf_width; ++lane) {
    const bool used = lane < part.size();
    for (int axis = 0; axis < 3; ++axis)
      leaves[leaf].at[axis][lane] = used ? part[lane].at[axis] : not_a_number;
    if (!used) continue;
    const std::uint32_t index = part[lane].index;
    const std::size_t place = std::size_t{leaf} * leaf_width + lane;
    records[place] = {points_m[index], index};
    place_of[index] = static_cast<std::uint32_t>(place);
  }
}

BoxTree empty_tree(std::span<const Eigen::Vector3d> points_m) {
  static const TreeKernels* const quickest = usable_kernels().front();
  BoxTree tree;
  tree.frame = local_frame(points_m);
  tree.place_of.assign(points_m.size(), nothing);
  tree.kernels = quickest;
  return tree;
}

TreeNode empty_node() {
  TreeNode node;
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(node.low[axis], node_width, not_a_number);
    std::fill_n(node.high[axis], node_width, not_a_number);
  }
  std::fill_n(node.child, node_width, nothing);
  std::fill_n(node.plane, node_width - 1, std::numeric_limits<float>::infinity());
  node.axes = 0;
  return node;
}

void set_child(TreeNode& node, unsigned lane, std::uint32_t child, const TreeBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = box.low[axis];
    node.high[axis][lane] = box.high[axis];
  }
  node.child[lane] = child;
}

std::vector<const TreeKernels*> usable_kernels() {
  std::vector<const TreeKernels*> usable;
  if (__builtin_cpu_supports("avx512f")) usable.push_back(&avx512_kernels);
  if (__builtin_cpu_supports("avx2")) usable.push_back(&avx2_kernels);
  usable.push_back(&sse2_kernels);
  return usable;
}

}  // namespace scan
