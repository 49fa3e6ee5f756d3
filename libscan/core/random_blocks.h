// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many blocks of the random streams at once, for sensors that read millions of pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace scan {

// Block `block` of the stream of a ray, in a scan whose seed and number are the same for all.
struct BlockAddress {
  std::uint64_t ray = 0;
  std::uint64_t block = 0;  // below 2^32
};

// The four words of each block: words[4 i + j] is word j of blocks[i].
void draw_words(std::uint64_t seed, std::uint32_t scan, std::span<const BlockAddress> blocks,
                std::span<std::uint32_t> words);

// Four normal numbers of each block, in the same order, by Box and Muller: a radius by word 0 (2)
// and an angle by word 1 (3), each at the middle of its 2^-32. So none lies beyond 6.8. In
// floats: the radius's square is off by at most 3e-7 of itself and 1.2e-7, the angle by 3e-7, hence
// no probability by more than 2e-7. The bytes do not depend on the processor.
void draw_normals(std::uint64_t seed, std::uint32_t scan, std::span<const BlockAddress> blocks,
                  std::span<float> normals);

// The versions of draw_normals that this processor can run.
using NormalsKernel = void(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                           std::size_t count, float* normals);
std::span<NormalsKernel* const> normals_kernels();

}  // namespace scan
