// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The walk through a tree of boxes, for any instruction set, whose Eight, Query and operations
// stand before it (tree_queries.h). Internal to libscan/search.
//
// On the way down the child is chosen by the node's planes: three comparisons tell where the query
// lies long before the distances to the eight boxes are known, which are computed in the shadow of
// the loads. They are kept in rows, and compared with the limit on the way back, eight at a time.
#pragma once

#include "libscan/search/tree_kernels.h"

namespace scan {
namespace {

inline int first_of(std::uint32_t lanes) {
  return __builtin_ctz(lanes);
}

class Walker {
 public:
  Walker(const TreeView& tree, const TreeQuery& query, TreeWalk& walk)
      : tree_(tree), query_(query.at), rows_(walk.rows), end_(walk.end) {}

  // The first and the next leaf whose box is within the limit, or `nothing`.
  std::uint32_t first(float limit2) {
    const std::uint32_t leaf = down(tree_.root, limit2);
    return leaf != nothing ? leaf : next(limit2);
  }
  std::uint32_t next(float limit2) {
    for (std::uint32_t child = back(limit2); child != nothing; child = back(limit2))
      if (const std::uint32_t leaf = down(child, limit2); leaf != nothing) return leaf;
    return nothing;
  }
  TreeWalk::Row* end() const { return end_; }
  const Query& query() const { return query_; }

 private:
  std::uint32_t down(std::uint32_t child, float limit2) {
    while ((child & leaf_bit) == 0) {
      const TreeNode& node = tree_.nodes[child];
      const Eight distance2 = box_distances2(node, query_);
      const std::uint32_t near = not_above(distance2, limit2);
      int lane = lane_of_cell(node, query_);
      if ((near >> lane & 1u) == 0) {
        if (near == 0) return nothing;
        lane = first_of(near);
      }
      store(distance2, end_->distance2);
      end_->node = child;
      end_->left = ~(1u << lane);
      ++end_;
      child = node.child[lane];
    }
    return child & ~leaf_bit;
  }

  std::uint32_t back(float limit2) {
    for (; end_ != rows_; --end_) {
      TreeWalk::Row& row = end_[-1];
      const std::uint32_t near = not_above(load(row.distance2), limit2) & row.left;
      if (near == 0) continue;
      row.left = near & (near - 1);
      return tree_.nodes[row.node].child[first_of(near)];
    }
    return nothing;
  }

  TreeView tree_;
  Query query_;
  TreeWalk::Row* rows_;
  TreeWalk::Row* end_;
};

}  // namespace
}  // namespace scan
