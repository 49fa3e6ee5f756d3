// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/tree_lanes_avx2.h"

namespace scan {
namespace {

struct Sixteen {
  __m256 half[2];
};

struct Query {
  __m256 at[3], by_axis;
  explicit Query(const float (&q)[3])
      : at{_mm256_set1_ps(q[0]), _mm256_set1_ps(q[1]), _mm256_set1_ps(q[2])},
        by_axis(_mm256_setr_ps(q[0], q[1], q[2], 0, q[0], q[1], q[2], 0)) {}
};

inline Eight box_distances2(const TreeNode& node, const Query& query) {
  return box_distances2(node, query.at);
}

inline int lane_of_cell(const TreeNode& node, const Query& query) {
  return lane_of_cell(node, query.by_axis);
}

inline Sixteen point_distances2(const TreeLeaf& leaf, const Query& query) {
  Sixteen distance2;
  for (int i = 0; i < 2; ++i) {
    const __m256 x = load(leaf.at[0] + 8 * i) - query.at[0];
    const __m256 y = load(leaf.at[1] + 8 * i) - query.at[1];
    const __m256 z = load(leaf.at[2] + 8 * i) - query.at[2];
    distance2.half[i] = x * x + y * y + z * z;
  }
  return distance2;
}

inline void store(const Sixteen& values, std::uint32_t* bits) {
  for (int i = 0; i < 2; ++i)
    _mm256_store_si256(reinterpret_cast<__m256i*>(bits + 8 * i),
                       _mm256_castps_si256(values.half[i]));
}

inline std::uint32_t not_above(const Sixteen& values, float limit) {
  return not_above(values.half[0], limit) | not_above(values.half[1], limit) << 8;
}

// The least of all lanes that are numbers, of which there is one at least.
inline float least_of(const Sixteen& values, std::uint32_t) {
  const __m256 none = _mm256_set1_ps(__builtin_inff());
  // Of two numbers of which one is not, min_ps returns the second.
  __m256 v = _mm256_min_ps(values.half[1], _mm256_min_ps(values.half[0], none));
  v = _mm256_min_ps(v, _mm256_permute2f128_ps(v, v, 1));
  v = _mm256_min_ps(v, _mm256_permute_ps(v, 0x4e));
  return _mm256_cvtss_f32(_mm256_min_ps(v, _mm256_permute_ps(v, 0xb1)));
}

// Each entry becomes the middle one of itself, the new one and the entry before.
inline void insert(std::uint64_t entry, std::uint64_t* best, int capacity) {
  const __m256i added = _mm256_set1_epi64x(static_cast<long long>(entry));
  __m256i before = _mm256_setzero_si256();
  for (int i = 0; i < capacity; i += 4) {
    auto* at = reinterpret_cast<__m256i*>(best + i);
    const __m256i old = _mm256_load_si256(at);
    const __m256i shifted =
        _mm256_alignr_epi8(old, _mm256_permute2x128_si256(before, old, 0x21), 8);
    const __m256i upper = _mm256_blendv_epi8(added, shifted, _mm256_cmpgt_epi64(shifted, added));
    _mm256_store_si256(at, _mm256_blendv_epi8(old, upper, _mm256_cmpgt_epi64(old, upper)));
    before = old;
  }
}

}  // namespace
}  // namespace scan

#include "libscan/search/tree_patch_queries.h"
#include "libscan/search/tree_queries.h"

namespace scan {
const TreeKernels avx2_kernels = {"AVX2", nearest, k_nearest, next_leaf, nearest_in};
}  // namespace scan
