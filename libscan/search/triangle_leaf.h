// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Up to eight triangles, each held by half-spaces in single precision that bound a query's distance
// from below: tightly enough that few triangles are left to decide in double. Internal to
// libscan/search.
#pragma once

#include <emmintrin.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace scan {

// A triangle's corners x have low <= normal . x <= high, and outward . x <= reach for each edge,
// `outward` lying in the triangle's plane. Let a query be d1 outside the first and d2 outside the
// worst of the others: any point within both is sqrt(d1^2 + d2^2) away at least, since the normals
// are at right angles. That is the distance itself unless the nearest point is a corner.
//
// In local units (LocalFrame) and float, with a query of largest coordinate |q|: the products of
// normal . q and their sum are off by at most 4 2^-24 sqrt(3) |q|, q's own rounding moves it by
// sqrt(3) 2^-24 |q|, and the bounds, at most sqrt(3), are off by as much for their rounding, the
// difference's not more. So d1 and d2 are at most 5 sqrt(3) 2^-24 (1 + |q|) < 4.4 slack too large
// (slack: LocalQuery), the bound sqrt(2) times that, which is less than leaf_slack times it. The
// normals' lengths are true to 2^-24 and their right angle to 2^-22, and the square has seven
// roundings of 2^-24: together less than the 2^-20 that LocalQuery::limit2 leaves.
struct alignas(64) TriangleLeaf {
  static constexpr int width = 8;
  static constexpr double leaf_slack = 8;

  float normal[3][width];
  float low[width], high[width];
  float outward[3][3][width];  // edge by edge
  float reach[3][width];
  std::uint32_t first, count;  // in leaf order

  // Of a degenerate triangle the half-spaces that it does not have hold everything.
  void set(int lane, const std::array<Eigen::Vector3d, 3>& local_corners);

  // Lower bounds of the squared distances; a bit for each triangle whose is within the limit.
  unsigned within(const __m128 (&at)[3], float limit2, float* distances2) const;
};

inline __m128 dot(const float (&normals)[3][TriangleLeaf::width], int lane, const __m128 (&at)[3]) {
  const __m128 x = _mm_mul_ps(_mm_load_ps(normals[0] + lane), at[0]);
  const __m128 y = _mm_mul_ps(_mm_load_ps(normals[1] + lane), at[1]);
  const __m128 z = _mm_mul_ps(_mm_load_ps(normals[2] + lane), at[2]);
  return _mm_add_ps(_mm_add_ps(x, y), z);
}

inline unsigned TriangleLeaf::within(const __m128 (&at)[3], float limit2, float* distances2) const {
  unsigned lanes = 0;
  for (int i = 0; i < width; i += 4) {
    const __m128 along = dot(normal, i, at);
    __m128 off = _mm_sub_ps(along, _mm_load_ps(high + i));
    off = _mm_max_ps(off, _mm_sub_ps(_mm_load_ps(low + i), along));
    off = _mm_max_ps(off, _mm_setzero_ps());
    __m128 beside = _mm_setzero_ps();
    for (int edge = 0; edge < 3; ++edge)
      beside =
          _mm_max_ps(beside, _mm_sub_ps(dot(outward[edge], i, at), _mm_load_ps(reach[edge] + i)));
    const __m128 sum = _mm_add_ps(_mm_mul_ps(off, off), _mm_mul_ps(beside, beside));
    _mm_store_ps(distances2 + i, sum);
    const int found = _mm_movemask_ps(_mm_cmple_ps(sum, _mm_set1_ps(limit2)));
    lanes |= static_cast<unsigned>(found) << i;
  }
  return lanes & ((1u << count) - 1);
}

}  // namespace scan
