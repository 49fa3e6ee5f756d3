// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Operations on the eight children of a node by AVX2. Internal to libscan/search.
#pragma once

#include <immintrin.h>

#include "libscan/search/tree_kernels.h"

namespace scan {
namespace {

using Eight = __m256;

// The place behind the planes, for each set of planes that the query is on or above.
struct Places {
  unsigned char of[128] = {};
  constexpr Places() {
    for (unsigned above = 0; above < 128; ++above) {
      unsigned i = 0;
      while (i < 7) i = 2 * i + 1 + (above >> i & 1u);
      of[above] = static_cast<unsigned char>(i - 7);
    }
  }
};
constexpr Places places;

inline Eight load(const float* values) {
  return _mm256_load_ps(values);
}

inline void store(Eight values, float* to) {
  _mm256_store_ps(to, values);
}

inline std::uint32_t not_above(Eight values, float limit) {
  const __m256 near = _mm256_cmp_ps(values, _mm256_set1_ps(limit), _CMP_LE_OQ);
  return static_cast<std::uint32_t>(_mm256_movemask_ps(near));
}

// `at`: the query's coordinates, each eight times.
inline Eight box_distances2(const TreeNode& node, const __m256 (&at)[3]) {
  __m256 gap2[3];
  for (int axis = 0; axis < 3; ++axis) {
    const __m256 below = load(node.low[axis]) - at[axis], above = at[axis] - load(node.high[axis]);
    // Of two numbers of which one is not, max_ps returns the second: NaN boxes stay NaN.
    const __m256 gap = _mm256_max_ps(_mm256_max_ps(_mm256_setzero_ps(), below), above);
    gap2[axis] = gap * gap;
  }
  return gap2[0] + gap2[1] + gap2[2];
}

// `by_axis`: the coordinates x, y, z, 0, twice.
inline int lane_of_cell(const TreeNode& node, __m256 by_axis) {
  const __m256i shifts = _mm256_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14);
  const __m256i axes = _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(node.axes)), shifts);
  const __m256 at = _mm256_permutevar_ps(by_axis, axes);  // looks at the lowest two bits
  const __m256 on_or_above = _mm256_cmp_ps(at, load(node.plane), _CMP_GE_OQ);
  return places.of[_mm256_movemask_ps(on_or_above) & 127];
}

}  // namespace
}  // namespace scan
