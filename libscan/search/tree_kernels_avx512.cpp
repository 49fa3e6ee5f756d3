// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/tree_lanes_avx2.h"

namespace scan {
namespace {

using Sixteen = __m512;

struct Query {
  __m512 at[3];
  __m256 half_at[3], by_axis;
  explicit Query(const float (&q)[3])
      : at{_mm512_set1_ps(q[0]), _mm512_set1_ps(q[1]), _mm512_set1_ps(q[2])},
        half_at{_mm256_set1_ps(q[0]), _mm256_set1_ps(q[1]), _mm256_set1_ps(q[2])},
        by_axis(_mm256_setr_ps(q[0], q[1], q[2], 0, q[0], q[1], q[2], 0)) {}
};

inline Eight box_distances2(const TreeNode& node, const Query& query) {
  return box_distances2(node, query.half_at);
}

inline int lane_of_cell(const TreeNode& node, const Query& query) {
  return lane_of_cell(node, query.by_axis);
}

inline Sixteen point_distances2(const TreeLeaf& leaf, const Query& query) {
  const __m512 x = _mm512_load_ps(leaf.at[0]) - query.at[0];
  const __m512 y = _mm512_load_ps(leaf.at[1]) - query.at[1];
  const __m512 z = _mm512_load_ps(leaf.at[2]) - query.at[2];
  return x * x + y * y + z * z;
}

inline void store(Sixteen values, std::uint32_t* bits) {
  _mm512_store_ps(bits, values);
}

inline std::uint32_t not_above(Sixteen values, float limit) {
  return _mm512_cmp_ps_mask(values, _mm512_set1_ps(limit), _CMP_LE_OQ);
}

// The least of the given lanes.
inline float least_of(Sixteen values, std::uint32_t lanes) {
  return _mm512_mask_reduce_min_ps(static_cast<__mmask16>(lanes), values);
}

// Each entry becomes the middle one of itself, the new one and the entry before.
inline void insert(std::uint64_t entry, std::uint64_t* best, int capacity) {
  const __m512i added = _mm512_set1_epi64(static_cast<long long>(entry));
  __m512i before = _mm512_setzero_si512();
  for (int i = 0; i < capacity; i += 8) {
    const __m512i old = _mm512_load_si512(best + i);
    const __m512i shifted = _mm512_alignr_epi64(old, before, 7);
    _mm512_store_si512(best + i, _mm512_min_epu64(old, _mm512_max_epu64(shifted, added)));
    before = old;
  }
}

}  // namespace
}  // namespace scan

#include "libscan/search/tree_patch_queries.h"
#include "libscan/search/tree_queries.h"

namespace scan {
const TreeKernels avx512_kernels = {"AVX-512", nearest, k_nearest, next_leaf, nearest_in};
}  // namespace scan
