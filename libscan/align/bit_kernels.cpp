// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/bit_kernels.h"

#define SCAN_INLINE inline __attribute__((always_inline))

namespace scan {
namespace {

template <bool with_normals>
SCAN_INLINE std::uint64_t compare_row(const TileColumns& a, std::size_t i, const TileColumns& b,
                                      const TileLimits& limits) {
  alignas(32) std::int32_t agree[tile_width];
  const float sx = a.source[0][i], sy = a.source[1][i], sz = a.source[2][i];
  const float tx = a.target[0][i], ty = a.target[1][i], tz = a.target[2][i];
  const float *bsx = b.source[0], *bsy = b.source[1], *bsz = b.source[2];
  const float *btx = b.target[0], *bty = b.target[1], *btz = b.target[2];
  const float distance2 = limits.distance2, least2 = limits.least2;
  for (std::size_t j = 0; j < tile_width; ++j) {
    const float s = (sx - bsx[j]) * (sx - bsx[j]) + (sy - bsy[j]) * (sy - bsy[j]) +
                    (sz - bsz[j]) * (sz - bsz[j]);
    const float t = (tx - btx[j]) * (tx - btx[j]) + (ty - bty[j]) * (ty - bty[j]) +
                    (tz - btz[j]) * (tz - btz[j]);
    const float excess = s + t - distance2;
    agree[j] = ((excess <= 0) | (excess * excess <= 4 * s * t)) & (s >= least2) & (t >= least2);
  }
  if constexpr (with_normals) {
    const float nx = a.source_normal[0][i], ny = a.source_normal[1][i], nz = a.source_normal[2][i];
    const float mx = a.target_normal[0][i], my = a.target_normal[1][i], mz = a.target_normal[2][i];
    const float *bnx = b.source_normal[0], *bny = b.source_normal[1], *bnz = b.source_normal[2];
    const float *bmx = b.target_normal[0], *bmy = b.target_normal[1], *bmz = b.target_normal[2];
    const float cosine = limits.cosine;
    for (std::size_t j = 0; j < tile_width; ++j) {
      const float off =
          (nx * bnx[j] + ny * bny[j] + nz * bnz[j]) - (mx * bmx[j] + my * bmy[j] + mz * bmz[j]);
      agree[j] &= (off <= cosine) & (-off <= cosine);
    }
  }
  std::uint64_t bits = 0;
  for (std::size_t j = 0; j < tile_width; ++j) bits |= std::uint64_t(agree[j]) << j;
  return bits;
}

SCAN_INLINE void compare_rows(const TileColumns& a, const TileColumns& b, std::size_t rows,
                              const TileLimits& limits,
                              std::array<std::uint64_t, tile_width>& bits) {
  if (limits.cosine < 2)
    for (std::size_t i = 0; i < rows; ++i) bits[i] = compare_row<true>(a, i, b, limits);
  else
    for (std::size_t i = 0; i < rows; ++i) bits[i] = compare_row<false>(a, i, b, limits);
}

SCAN_INLINE std::size_t count_common(const std::uint64_t* a, const std::uint64_t* b,
                                     std::size_t words) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < words; ++k)
    count += static_cast<std::size_t>(__builtin_popcountll(a[k] & b[k]));
  return count;
}

#if defined(__x86_64__)
__attribute__((target("avx2,popcnt"))) void compare_avx2(
    const TileColumns& a, const TileColumns& b, std::size_t rows, const TileLimits& limits,
    std::array<std::uint64_t, tile_width>& bits) {
  compare_rows(a, b, rows, limits, bits);
}
__attribute__((target("avx2,popcnt"))) std::size_t common_avx2(const std::uint64_t* a,
                                                               const std::uint64_t* b,
                                                               std::size_t words) {
  return count_common(a, b, words);
}
const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");
#endif

}  // namespace

void compare_tile(const TileColumns& a, const TileColumns& b, std::size_t rows,
                  const TileLimits& limits, std::array<std::uint64_t, tile_width>& bits) {
#if defined(__x86_64__)
  if (has_avx2) return compare_avx2(a, b, rows, limits, bits);
#endif
  compare_rows(a, b, rows, limits, bits);
}

std::size_t common_bits(const std::uint64_t* a, const std::uint64_t* b, std::size_t words) {
#if defined(__x86_64__)
  if (has_avx2) return common_avx2(a, b, words);
#endif
  return count_common(a, b, words);
}

}  // namespace scan
