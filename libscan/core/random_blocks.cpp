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

// sqrt(-2 ln u) of u = (word + 1/2) 2^-32 = m 2^(e - 32) with m about 1: of the two terms of the
// logarithm, (32 - e) ln 2 - ln m, none cancels the other, so it is right to a few roundings of
// itself and to that of m, 2^-24.
SCAN_INLINE float radius_of(std::uint32_t word) {
  constexpr std::uint32_t sqrt_half = 0x3f3504f3u, bias = 64;
  const float x = static_cast<float>(static_cast<std::int32_t>(word >> 16)) * 65536.0F +
                  (static_cast<float>(static_cast<std::int32_t>(word & 0xffffu)) + 0.5F);
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t e = (bits - sqrt_half + (bias << 23)) >> 23;
  const float m = std::bit_cast<float>(bits - (e << 23) + (bias << 23));
  // ln m = 2 artanh s, |s| <= 0.172; the series' next term is 2 s^11 / 11 = 7e-10
  const float s = (m - 1) / (m + 1), z = s * s;
  const float series = 1 + z * (1.0F / 3 + z * (1.0F / 5 + z * (1.0F / 7 + z * (1.0F / 9))));
  const auto halvings = static_cast<float>(32 + static_cast<std::int32_t>(bias - e));
  const float square = 2 * (halvings * 0.69314718F - 2 * s * series);
  return square * inverse_sqrt(square);
}

// Cosine and sine of (word + 1/2) 2^-32 turns less an eighth: quarters by the highest two bits and
// an angle of at most pi / 4, where the series' next terms are x^12 / 12! = 1e-10 and x^11 / 11! =
// 2e-9.
SCAN_INLINE void turn(std::uint32_t word, float& cosine, float& sine) {
  const auto place = static_cast<std::int32_t>(word & 0x3fffffffu) - 0x20000000;
  const float x = (static_cast<float>(place) + 0.5F) * (1.5707963F * 0x1p-30F), z = x * x;
  const float s =
      x + x * z * (-1.0F / 6 + z * (1.0F / 120 + z * (-1.0F / 5040 + z * (1.0F / 362880))));
  const float c =
      1 + z * (-1.0F / 2 +
               z * (1.0F / 24 + z * (-1.0F / 720 + z * (1.0F / 40320 + z * (-1.0F / 3628800)))));
  const std::uint32_t quarters = word >> 30, odd = 0 - (quarters & 1);  // all bits
  const auto c_bits = std::bit_cast<std::uint32_t>(c), s_bits = std::bit_cast<std::uint32_t>(s);
  const std::uint32_t along = (c_bits & ~odd) | (s_bits & odd);
  const std::uint32_t across = (s_bits & ~odd) | (c_bits & odd);
  cosine = std::bit_cast<float>(along ^ (((quarters + 1) & 2) << 30));
  sine = std::bit_cast<float>(across ^ ((quarters & 2) << 30));
}

SCAN_INLINE void box_muller(const std::uint64_t* __restrict radius_words,
                            const std::uint64_t* __restrict angle_words, float* __restrict first,
                            float* __restrict second) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const float radius = radius_of(static_cast<std::uint32_t>(radius_words[i]));
    float cosine, sine;
    turn(static_cast<std::uint32_t>(angle_words[i]), cosine, sine);
    first[i] = radius * cosine;
    second[i] = radius * sine;
  }
}

template <unsigned bytes>
SCAN_INLINE void normals_of(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                            std::size_t count, float* normals) {
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t some = std::min(lanes, count - first);
    Words words;
    draw<bytes>(seed, scan, blocks + first, some, words);
    alignas(64) float values[4][lanes];
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
                   std::size_t count, float* normals) {
  normals_of<16>(seed, scan, blocks, count, normals);
}
SCAN_AVX2 void normals_avx2(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                            std::size_t count, float* normals) {
  normals_of<32>(seed, scan, blocks, count, normals);
}
SCAN_AVX512 void normals_avx512(std::uint64_t seed, std::uint32_t scan, const BlockAddress* blocks,
                                std::size_t count, float* normals) {
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
                  std::span<float> normals) {
  normals_versions.fastest()(seed, scan, blocks.data(), blocks.size(), normals.data());
}

std::span<NormalsKernel* const> normals_kernels() {
  return normals_versions.all();
}

}  // namespace scan
