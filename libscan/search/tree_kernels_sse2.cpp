// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <emmintrin.h>

#include "libscan/search/tree_kernels.h"

namespace scan {
namespace {

template <int width>
struct Lanes {
  __m128 four[width / 4];
};
using Eight = Lanes<node_width>;
using Sixteen = Lanes<leaf_width>;

struct Query {
  __m128 at[3];
  float by_axis[3];
  explicit Query(const float (&q)[3])
      : at{_mm_set1_ps(q[0]), _mm_set1_ps(q[1]), _mm_set1_ps(q[2])}, by_axis{q[0], q[1], q[2]} {}
};

inline Eight load(const float* values) {
  return {{_mm_load_ps(values), _mm_load_ps(values + 4)}};
}

inline void store(const Eight& values, float* to) {
  for (int i = 0; i < 2; ++i) _mm_store_ps(to + 4 * i, values.four[i]);
}

inline void store(const Sixteen& values, std::uint32_t* bits) {
  for (int i = 0; i < 4; ++i)
    _mm_store_si128(reinterpret_cast<__m128i*>(bits + 4 * i), _mm_castps_si128(values.four[i]));
}

template <int width>
std::uint32_t not_above(const Lanes<width>& values, float limit) {
  const __m128 most = _mm_set1_ps(limit);
  std::uint32_t lanes = 0;
  for (int i = 0; i < width / 4; ++i)
    lanes |= static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(values.four[i], most)))
             << (4 * i);
  return lanes;
}

inline Eight box_distances2(const TreeNode& node, const Query& query) {
  Eight distance2;
  for (int i = 0; i < 2; ++i) {
    __m128 gap2[3];
    for (int axis = 0; axis < 3; ++axis) {
      const __m128 below = _mm_load_ps(node.low[axis] + 4 * i) - query.at[axis];
      const __m128 above = query.at[axis] - _mm_load_ps(node.high[axis] + 4 * i);
      // Of two numbers of which one is not, max_ps returns the second: NaN boxes stay NaN.
      const __m128 gap = _mm_max_ps(_mm_max_ps(_mm_setzero_ps(), below), above);
      gap2[axis] = gap * gap;
    }
    distance2.four[i] = gap2[0] + gap2[1] + gap2[2];
  }
  return distance2;
}

inline int lane_of_cell(const TreeNode& node, const Query& query) {
  int i = 0;
  while (i < 7) i = 2 * i + 1 + (query.by_axis[node.axes >> (2 * i) & 3u] >= node.plane[i] ? 1 : 0);
  return i - 7;
}

inline Sixteen point_distances2(const TreeLeaf& leaf, const Query& query) {
  Sixteen distance2;
  for (int i = 0; i < 4; ++i) {
    const __m128 x = _mm_load_ps(leaf.at[0] + 4 * i) - query.at[0];
    const __m128 y = _mm_load_ps(leaf.at[1] + 4 * i) - query.at[1];
    const __m128 z = _mm_load_ps(leaf.at[2] + 4 * i) - query.at[2];
    distance2.four[i] = x * x + y * y + z * z;
  }
  return distance2;
}

// The least of all lanes that are numbers, of which there is one at least.
inline float least_of(const Sixteen& values, std::uint32_t) {
  __m128 v = _mm_set1_ps(__builtin_inff());
  // Of two numbers of which one is not, min_ps returns the second.
  for (const __m128& four : values.four) v = _mm_min_ps(four, v);
  v = _mm_min_ps(v, _mm_shuffle_ps(v, v, 0x4e));
  return _mm_cvtss_f32(_mm_min_ps(v, _mm_shuffle_ps(v, v, 0xb1)));
}

inline void insert(std::uint64_t entry, std::uint64_t* best, int capacity) {
  int place = capacity - 1;
  if (best[place] <= entry) return;
  for (; place > 0 && entry < best[place - 1]; --place) best[place] = best[place - 1];
  best[place] = entry;
}

}  // namespace
}  // namespace scan

#include "libscan/search/tree_patch_queries.h"
#include "libscan/search/tree_queries.h"

namespace scan {
const TreeKernels sse2_kernels = {"SSE2", nearest, k_nearest, next_leaf, nearest_in};
}  // namespace scan
