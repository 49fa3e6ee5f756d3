// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The kernels, for any instruction set: each tree_kernels_*.cpp includes this once, behind its own
// Eight (distances to the boxes of a node), Sixteen (to the points of a leaf), Query and the
// operations on them: box_distances2, point_distances2, lane_of_cell, load, store, not_above,
// least_of, insert. Internal to libscan/search.
#pragma once

#include "libscan/search/tree_walk.h"

namespace scan {
namespace {

// The points so far that may be the nearest.
struct Best {
  float distance2 = __builtin_inff();  // of the nearest by float
  float limit2;
  RawNearest found = {{}, 0};

  void look_into(std::uint32_t leaf, const Sixteen& leaf_distance2, float widening) {
    std::uint32_t near = not_above(leaf_distance2, limit2);
    if (near == 0) return;
    const float least = least_of(leaf_distance2, near);
    if (least < distance2) {
      const float new_limit2 = widened(least, widening);
      limit2 = new_limit2 < limit2 ? new_limit2 : limit2;
      if (distance2 > limit2) found.count = 0;  // and the others are not nearer
      distance2 = least;
      near = not_above(leaf_distance2, limit2);
    }
    for (; near != 0; near &= near - 1, ++found.count)
      if (found.count < RawNearest::kept)
        found.places[found.count] = leaf * leaf_width + static_cast<std::uint32_t>(first_of(near));
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
  const auto look_into = [&](std::uint32_t leaf) {
    const Sixteen distance2 = point_distances2(tree.leaves[leaf], walker.query());
    std::uint32_t near = not_above(distance2, limit2);
    if (near == 0) return;
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
  };
  if (query.first_leaf != nothing) look_into(query.first_leaf);
  for (std::uint32_t leaf = walker.first(limit2); leaf != nothing; leaf = walker.next(limit2))
    if (leaf != query.first_leaf) look_into(leaf);
  return limit2;
}

LeafHits next_leaf(const TreeView& tree, const TreeQuery& query, TreeWalk& walk) {
  Walker walker(tree, query, walk);
  std::uint32_t leaf = walk.begun ? walker.next(query.limit2) : walker.first(query.limit2);
  walk.begun = true;
  std::uint32_t lanes = 0;
  while (leaf != nothing) {
    lanes = not_above(point_distances2(tree.leaves[leaf], walker.query()), query.limit2);
    if (lanes != 0) break;
    leaf = walker.next(query.limit2);
  }
  walk.end = walker.end();
  return {leaf, lanes};
}

}  // namespace
}  // namespace scan
