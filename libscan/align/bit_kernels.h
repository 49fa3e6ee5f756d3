// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The inner loops of the compatibility graph and of its cliques, over raw arrays: for AVX2 where
// the machine has it, else for the baseline. Both do the same operations, so the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace scan {

inline constexpr std::size_t tile_width = 64;

// The first of `tile_width` correspondences in arrays of coordinates: x, y, z of each field.
struct TileColumns {
  std::array<const float*, 3> source, target, source_normal, target_normal;
};

struct TileLimits {
  float distance2 = 0, least2 = 0, cosine = 2;
};

// Bit j of bits[i] for i < rows: a's i and b's j keep their distance within the limits (squared
// ones, s and t, do if s + t <= e^2 or (s + t - e^2)^2 <= 4 s t: |sqrt s - sqrt t| <= e without a
// root) and the cosine between their normals; all cosines agree for a limit of 2.
void compare_tile(const TileColumns& a, const TileColumns& b, std::size_t rows,
                  const TileLimits& limits, std::array<std::uint64_t, tile_width>& bits);

// Number of bits set in both.
std::size_t common_bits(const std::uint64_t* a, const std::uint64_t* b, std::size_t words);

}  // namespace scan
