// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/random_blocks.h"

#include <algorithm>
#include <cstring>
#if defined(__x86_64__) && !defined(__clang__)
#include <immintrin.h>
#endif

#include "libscan/core/vector_math.h"

// Wide values never cross a call: all that takes them is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // of g++'s own immintrin.h
#endif

namespace scan {
namespace {

constexpr std::size_t lanes = 16;

// Words of `lanes` blocks, each in 64 bits.
struct Words {
  alignas(64) std::uint64_t of[4][lanes];
};

template <unsigned bytes>
struct Wide {
  using Words [[gnu::vector_size(bytes)]] = std::uint64_t;
};

// The whole products of the elements' lower halves. (g++ needs to be told that there is one
// instruction for it.)
#if defined(__x86_64__) && !defined(__clang__)
inline Wide<16>::Words product(Wide<16>::Words a, Wide<16>::Words b) {
  return (Wide<16>::Words)_mm_mul_epu32((__m128i)a, (__m128i)b);
}
SCAN_AVX2 inline Wide<32>::Words product(Wide<32>::Words a, Wide<32>::Words b) {
  return (Wide<32>::Words)_mm256_mul_epu32((__m256i)a, (__m256i)b);
}
SCAN_AVX512 inline Wide<64>::Words product(Wide<64>::Words a, Wide<64>::Words b) {
  return (Wide<64>::Words)_mm512_mul_epu32((__m512i)a, (__m512i)b);
}
#else
template <class Words>
SCAN_INLINE Words product(const Words& a, const Words& b) {
  return (a & 0xFFFFFFFFu) * (b & 0xFFFFFFFFu);
}
#endif

// Philox4x32-10 of random.h, blocks side by side; of each 64 bits the lower 32 count.
template <unsigned bytes>
SCAN_INLINE void philox(std::uint64_t seed, std::uint64_t* c0_, std::uint64_t* c1_,
                        std::uint64_t* c2_, std::uint64_t* c3_) {
  using V = typename Wide<bytes>::Words;
  V c0, c1, c2, c3;
  std::memcpy(&c0, c0_, bytes);
  std::memcpy(&c1, c1_, bytes);
  std::memcpy(&c2, c2_, bytes);
  std::memcpy(&c3, c3_, bytes);
  const V zero = {};
  auto k0 = static_cast<std::uint32_t>(seed), k1 = static_cast<std::uint32_t>(seed >> 32);
  for (int round = 0; round < 10; ++round) {
    const V p0 = product(zero + 0xD2511F53u, c0), p1 = product(zero + 0xCD9E8D57u, c2);
    c0 = (p1 >> 32) ^ c1 ^ std::uint64_t{k0};
    c1 = p1;
    c2 = (p0 >> 32) ^ c3 ^ std::uint64_t{k1};
    c3 = p0;
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  const V low = zero + 0xFFFFFFFFu;
  c0 &= low;
  c1 &= low;
  c2 &= low;
  c3 &= low;
  std::memcpy(c0_, &c0, bytes);
  std::memcpy(c1_, &c1, bytes);
  std::memcpy(c2_, &c2, bytes);
  std::memcpy(c3_, &c3, bytes);
}

// Of up to `lanes` blocks; what lies beyond `count` repeats the first.
template <unsigned bytes>
SCAN_INLINE void draw(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                      std::size_t count, Words& words) {
  BlockAddress at[lanes];
  for (std::size_t i = 0; i < lanes; ++i) at[i] = blocks[i < count ? i : 0];
  for (std::size_t i = 0; i < lanes; ++i) {
    words.of[0][i] = at[i].block;
    words.of[1][i] = scan;
    words.of[2][i] = at[i].ray;
    words.of[3][i] = at[i].ray >> 32;
  }
  for (std::size_t i = 0; i < lanes; i += bytes / 8)
    philox<bytes>(seed, words.of[0] + i, words.of[1] + i, words.of[2] + i, words.of[3] + i);
}

SCAN_INLINE void box_muller(const std::uint64_t* radius_words, const std::uint64_t* angle_words,
                            double* __restrict first, double* __restrict second) {
  constexpr double log_of_range = 22.180709777918249;  // 32 log 2
  constexpr std::uint64_t quarter = 0x3fffffff;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double square =
        2 * (log_of_range - logarithm(to_double(radius_words[i]) + 0.5));  // > 2e-10
    const double radius = square * inverse_sqrt(square);
    const double t = (to_double(angle_words[i] & quarter) + 0.5) * 0x1p-30 - 0.5;
    const Turned angle = turned(angle_words[i] >> 30, t);
    first[i] = radius * angle.cosine;
    second[i] = radius * angle.sine;
  }
}

template <unsigned bytes>
SCAN_INLINE void normals_of(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                            std::size_t count, double* normals) {
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t some = std::min(lanes, count - first);
    Words words;
    draw<bytes>(seed, scan, blocks + first, some, words);
    alignas(64) double values[4][lanes];
    box_muller(words.of[0], words.of[1], values[0], values[1]);
    box_muller(words.of[2], words.of[3], values[2], values[3]);
    for (std::size_t i = 0; i < some; ++i)
      for (std::size_t j = 0; j < 4; ++j) normals[4 * (first + i) + j] = values[j][i];
  }
}

template <unsigned bytes>
SCAN_INLINE void words_of(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                          std::size_t count, std::uint32_t* out) {
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t some = std::min(lanes, count - first);
    Words words;
    draw<bytes>(seed, scan, blocks + first, some, words);
    for (std::size_t i = 0; i < some; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        out[4 * (first + i) + j] = static_cast<std::uint32_t>(words.of[j][i]);
  }
}

using WordsKernel = void(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                         std::size_t count, std::uint32_t* words);

void normals_plain(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                   std::size_t count, double* normals) {
  normals_of<16>(seed, scan, blocks, count, normals);
}
SCAN_AVX2 void normals_avx2(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                            std::size_t count, double* normals) {
  normals_of<32>(seed, scan, blocks, count, normals);
}
SCAN_AVX512 void normals_avx512(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                                std::size_t count, double* normals) {
  normals_of<64>(seed, scan, blocks, count, normals);
}
void words_plain(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                 std::size_t count, std::uint32_t* words) {
  words_of<16>(seed, scan, blocks, count, words);
}
SCAN_AVX2 void words_avx2(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                          std::size_t count, std::uint32_t* words) {
  words_of<32>(seed, scan, blocks, count, words);
}
SCAN_AVX512 void words_avx512(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                              std::size_t count, std::uint32_t* words) {
  words_of<64>(seed, scan, blocks, count, words);
}

const Versions<NormalsKernel> normals_versions(normals_plain, normals_avx2, normals_avx512);
const Versions<WordsKernel> words_versions(words_plain, words_avx2, words_avx512);

}  // namespace

void draw_words(std::uint64_t seed, std::uint32_t scan, std::span<const BlockAddress> blocks,
                std::span<std::uint32_t> words) {
  words_versions.fastest()(seed, scan, blocks.data(), blocks.size(), words.data());
}

void draw_normals(std::uint64_t seed, std::uint32_t scan, std::span<const BlockAddress> blocks,
                  std::span<double> normals) {
  normals_versions.fastest()(seed, scan, blocks.data(), blocks.size(), normals.data());
}

std::span<NormalsKernel* const> normals_kernels() {
  return normals_versions.all();
}

}  // namespace scan
