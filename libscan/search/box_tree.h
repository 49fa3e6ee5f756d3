// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The tree of boxes that KdTree and Octree build, each by its own splits. Internal to
// libscan/search.
#pragma once

#include "libscan/search/large_array.h"
#include "libscan/search/local_frame.h"
#include "libscan/search/tree_kernels.h"

namespace scan {

// The smallest box of some points, at least one, in local units.
struct TreeBox {
  std::array<float, 3> low, high;
  explicit TreeBox(std::span<const LocalPoint> points);
};

struct BoxTree {
  struct Record {
    Eigen::Vector3d point_m;
    std::uint32_t index;  // in the caller's list
  };
  LocalFrame frame;
  std::size_t points = 0;  // the finite ones
  LargeArray<TreeNode> nodes;
  LargeArray<TreeLeaf> leaves;
  LargeArray<Record> records;           // by place: leaf * leaf_width + lane
  std::vector<std::uint32_t> place_of;  // each of the caller's points; or nothing
  std::uint32_t root = nothing;
  const TreeKernels* kernels = nullptr;

  TreeView view() const { return {nodes.data(), leaves.data(), root}; }
  // Makes room for the leaves. Throws scan::Error (resource) if there are too many to number.
  void resize(std::size_t leaf_count);
  void fill(std::uint32_t leaf, std::span<const LocalPoint> part,
            std::span<const Eigen::Vector3d> points_m);
};
static_assert(sizeof(BoxTree::Record) == 32);

// A tree without nodes and leaves, and the points to be put in.
BoxTree empty_tree(std::span<const Eigen::Vector3d> points_m);

// A node without children.
TreeNode empty_node();
void set_child(TreeNode& node, unsigned lane, std::uint32_t child, const TreeBox& box);

BoxTree build_kd_tree(std::span<const Eigen::Vector3d> points_m);
BoxTree build_octree(std::span<const Eigen::Vector3d> points_m);

// The kernel sets that this machine can run, the quickest first.
std::vector<const TreeKernels*> usable_kernels();

}  // namespace scan
