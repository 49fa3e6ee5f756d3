// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The walk through a tree of boxes, for any instruction set: each tree_kernels_*.cpp includes this
// once, behind its own Eight, Sixteen, Query and the operations on them. Internal to
// libscan/search.
//
// On the way down the child is chosen by the node's planes: three comparisons tell where the query
// lies long before the distances to the eight boxes are known, which are computed in the shadow of
// the loads. They are kept in rows, and compared with the limit on the way back, eight at a time.
#pragma once

#include "libscan/search/tree_kernels.h"

namespace scan {
namespace {

// The largest squared float distance of a point that may in truth be as near as one at distance2.
inline float widened(float distance2, float widening) {
  const float distance = __builtin_sqrtf(distance2) * (1 + 0x1p-19f) + widening;
  return distance * distance * (1 + 0x1p-18f);
}

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

// The nearest point so far, and whether another may be as near.
struct Best {
  float distance2 = __builtin_inff();
  float limit2;
  RawNearest found = {nothing, false};

  void look_into(std::uint32_t leaf, const Sixteen& leaf_distance2, float widening) {
    const std::uint32_t near = not_above(leaf_distance2, limit2);
    if (near == 0) return;
    const float least = least_of(leaf_distance2, near);
    if (!(least < distance2)) {
      found.unsure = true;
      return;
    }
    const float new_limit2 = widened(least, widening);
    limit2 = new_limit2 < limit2 ? new_limit2 : limit2;
    const std::uint32_t rivals = not_above(leaf_distance2, limit2);
    found.unsure = distance2 <= limit2 || (rivals & (rivals - 1)) != 0;
    found.place =
        leaf * leaf_width + static_cast<std::uint32_t>(first_of(not_above(leaf_distance2, least)));
    distance2 = least;
  }
};

RawNearest nearest(const TreeView& tree, const TreeQuery& query) {
  Best best{.limit2 = query.limit2};
  TreeWalk walk;
  Walker walker(tree, query, walk);
  const auto look_into = [&](std::uint32_t leaf) {
    best.look_into(leaf, point_distances2(tree.leaves[leaf], walker.query()), query.widening);
  };
  if (query.first_leaf != nothing) look_into(query.first_leaf);
  for (std::uint32_t leaf = walker.first(best.limit2); leaf != nothing;
       leaf = walker.next(best.limit2))
    if (leaf != query.first_leaf) look_into(leaf);
  return best.found;
}

float k_nearest(const TreeView& tree, const TreeQuery& query, int k, int capacity,
                std::uint64_t* best) {
  for (int i = 0; i < capacity; ++i) best[i] = no_entry;
  float limit2 = query.limit2;
  TreeWalk walk;
  Walker walker(tree, query, walk);
  for (std::uint32_t leaf = walker.first(limit2); leaf != nothing; leaf = walker.next(limit2)) {
    const Sixteen distance2 = point_distances2(tree.leaves[leaf], walker.query());
    std::uint32_t near = not_above(distance2, limit2);
    if (near == 0) continue;
    alignas(64) std::uint32_t bits[leaf_width];
    store(distance2, bits);
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(first_of(near));
      insert(std::uint64_t{bits[lane]} << 32 | (leaf * leaf_width + lane), best, capacity);
    }
    const auto kth_bits = static_cast<std::uint32_t>(best[k - 1] >> 32);
    float kth;
    __builtin_memcpy(&kth, &kth_bits, sizeof kth);
    const float new_limit2 = widened(kth, query.widening);
    limit2 = new_limit2 < limit2 ? new_limit2 : limit2;
  }
  return limit2;
}

LeafHits next_leaf(const TreeView& tree, const TreeQuery& query, TreeWalk& walk) {
  Walker walker(tree, query, walk);
  std::uint32_t leaf = walk.begun ? walker.next(query.limit2) : walker.first(query.limit2);
  walk.begun = true;
  LeafHits hits{nothing, 0};
  for (; leaf != nothing && hits.lanes == 0;) {
    hits = {leaf, not_above(point_distances2(tree.leaves[leaf], walker.query()), query.limit2)};
    if (hits.lanes == 0) leaf = walker.next(query.limit2);
  }
  walk.end = walker.end();
  return hits;
}

}  // namespace
}  // namespace scan
