// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The float side of the tree searches: a tree of boxes as raw arrays, and the kernels that walk it,
// one set per instruction set. Internal to libscan/search.
//
// The kernels' files are compiled for their instruction sets, so they know of this header and the
// compiler's intrinsics only: neither Eigen, whose types change their layout with the instruction
// set, nor the standard library, whose inline functions the linker would share with other files.
// All sets do the same operations in the same order and so return the same bytes.
#pragma once

#include <cstdint>

namespace scan {

inline constexpr int node_width = 8;      // children of a node
inline constexpr int leaf_width = 16;     // points of a leaf
inline constexpr int most_in_patch = 64;  // points near one of a patch; more would not pay
inline constexpr int tree_depth = 168;    // most nodes between the root and a leaf (octree.cpp)
inline constexpr std::uint32_t nothing = 0xffffffffu;
inline constexpr std::uint32_t leaf_bit = 0x80000000u;  // a child that is a leaf, by its number

// Boxes of the children, coordinate by coordinate; NaN, which no bound admits, where there is none.
// The planes divide the node's space in halves, quarters and eighths: behind plane i are 2 i + 1
// and 2 i + 2, and the eighths are the children's places in order; infinity: nothing lies above.
struct alignas(64) TreeNode {
  float low[3][node_width], high[3][node_width];
  std::uint32_t child[node_width];
  float plane[node_width - 1];
  std::uint32_t axes;  // of plane i: bits 2 i and 2 i + 1
};
static_assert(sizeof(TreeNode) == 256);

// Points, coordinate by coordinate, filled up with NaN.
struct alignas(64) TreeLeaf {
  float at[3][leaf_width];
};

struct TreeView {
  const TreeNode* nodes;
  const TreeLeaf* leaves;
  std::uint32_t root;  // as a child
};

// `limit2`: points and boxes beyond this squared distance are passed by.
struct TreeQuery {
  float at[3];
  float limit2;
  float widening;            // see LocalQuery
  std::uint32_t first_leaf;  // to look into before all others; or nothing
};

// The points that may be the nearest in truth. A place is leaf * leaf_width + lane; if there are
// more than are kept, `count` tells it.
struct RawNearest {
  static constexpr std::uint32_t kept = 4;
  std::uint32_t places[kept];
  std::uint32_t count;
};

// The largest squared float distance of a point that may in truth be as near as one at distance2.
// Static, so that no file gets a copy that another file's instruction set was used for.
static inline float widened(float distance2, float widening) {
  const float distance = __builtin_sqrtf(distance2) * (1 + 0x1p-19f) + widening;
  return distance * distance * (1 + 0x1p-18f);
}

// A walk to all leaves with points within a limit that may shrink on the way. A row holds the boxes
// of a node on the path from the root and which of its children are left.
struct TreeWalk {
  struct alignas(64) Row {
    float distance2[node_width];
    std::uint32_t node, left;
  };
  Row rows[tree_depth];
  Row* end = rows;
  bool begun = false;
};
struct LeafHits {
  std::uint32_t leaf, lanes;  // bit i: lane i is within the limit; no lanes: the walk is over
};

struct TreeKernels {
  const char* instruction_set;
  RawNearest (*nearest)(const TreeView&, const TreeQuery&);
  // The `capacity` (a multiple of 8) nearest of the points that may be among the k nearest, sorted;
  // entries are the bits of the squared distance above the place. Returns the limit of the k-th.
  float (*k_nearest)(const TreeView&, const TreeQuery&, int k, int capacity, std::uint64_t* best);
  LeafHits (*next_leaf)(const TreeView&, const TreeQuery&, TreeWalk&);
  // The places, nearest first, and the number of the given leaves' points that may be among the k
  // nearest. 0 if the limit holds fewer than k, or too many, or not all that may rival the k-th.
  int (*nearest_in)(const TreeView&, const TreeQuery&, const std::uint32_t* leaves, int count,
                    int k, std::uint32_t (&places)[most_in_patch]);
};

inline constexpr std::uint64_t no_entry = std::uint64_t{0x7f800000} << 32;  // infinitely far

extern const TreeKernels sse2_kernels, avx2_kernels, avx512_kernels;

}  // namespace scan
