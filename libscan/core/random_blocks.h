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
// and an angle by word 1 (3), each at the middle of its 2^-32. So none lies beyond 6.8, and their
// distribution is right to 1e-9. The bytes do not depend on the processor.
void draw_normals(std::uint64_t seed, std::uint32_t scan, std::span<const BlockAddress> blocks,
                  std::span<double> normals);

// The versions of draw_normals that this processor can run.
using NormalsKernel = void(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                           std::size_t count, double* normals);
std::span<NormalsKernel* const> normals_kernels();

}  // namespace scan
