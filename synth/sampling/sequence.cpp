// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/sampling/sequence.h"

#include <array>

#include "libscan/core/random.h"

namespace scan::synth {
namespace {

constexpr std::uint32_t dimensions = 4;  // of one group

// Sobol's direction numbers (1967) of a dimension as the columns of its generator matrix, by the
// recurrence of a primitive polynomial over GF(2), x^s + a_1 x^(s-1) + ... + 1 (Joe and Kuo 2008,
// eq. 2). Column i is what index bit i adds, most significant digit in bit 31.
constexpr std::array<std::uint32_t, 32> direction_numbers(int degree, std::uint32_t inner_terms,
                                                          std::array<std::uint32_t, 3> first) {
  std::array<std::uint32_t, 32> column{};
  for (int i = 0; i < 32; ++i) {
    if (i < degree) {
      column[i] = first[i] << (31 - i);
      continue;
    }
    column[i] = column[i - degree] ^ (column[i - degree] >> degree);
    for (int term = 1; term < degree; ++term)
      if (inner_terms >> (degree - 1 - term) & 1) column[i] ^= column[i - term];
  }
  return column;
}

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

// What each byte of an index adds to the digits of its point, least significant digit first: four
// look-ups for a matrix product.
using ByteTable = std::array<std::array<std::uint32_t, 256>, 4>;
constexpr ByteTable byte_table(const std::array<std::uint32_t, 32>& column) {
  ByteTable table{};
  for (int byte = 0; byte < 4; ++byte)
    for (std::uint32_t value = 0; value < 256; ++value)
      for (int bit = 0; bit < 8; ++bit)
        if (value >> bit & 1) table[byte][value] ^= reversed(column[8 * byte + bit]);
  return table;
}

// Dimension 0 is van der Corput's, whose digits are those of the index. The others take the first
// primitive polynomials, x + 1, x^2 + x + 1, x^3 + x + 1, with Joe and Kuo's first numbers.
constexpr std::array<ByteTable, dimensions - 1> tables = {
    byte_table(direction_numbers(1, 0, {1, 0, 0})), byte_table(direction_numbers(2, 1, {1, 3, 0})),
    byte_table(direction_numbers(3, 1, {1, 3, 1}))};

std::uint32_t sobol_digits(std::uint32_t index, std::uint32_t dimension) {
  if (dimension == 0) return index;
  const ByteTable& table = tables[dimension - 1];
  return table[0][index & 255] ^ table[1][index >> 8 & 255] ^ table[2][index >> 16 & 255] ^
         table[3][index >> 24];
}

// Owen's scrambling of digits, least significant first: each bit is flipped by a hash of the bits
// before it (Laine and Karras 2011; the multipliers of Burley 2020).
std::uint32_t scrambled(std::uint32_t digits, std::uint32_t seed) {
  digits += seed;
  digits ^= digits * 0x6c50b47cu;
  digits ^= digits * 0xb82f1e52u;
  digits ^= digits * 0xc7afe638u;
  digits ^= digits * 0x8d22f6e6u;
  return digits;
}

// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection that mixes all bits.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio, odd

}  // namespace

SampleSequence::SampleSequence(std::uint64_t seed, std::uint32_t scan, std::uint64_t ray,
                               std::uint32_t stream) {
  const auto word = [](std::uint64_t v) { return static_cast<std::uint32_t>(v); };
  // the seed's complement keeps clear of the RandomStream of the same address
  const auto block =
      philox4x32({stream, scan, word(ray), word(ray >> 32)}, {~word(seed), ~word(seed >> 32)});
  key_ = static_cast<std::uint64_t>(block[0]) << 32 | block[1];
}

void SampleSequence::start(std::uint32_t index) {
  index_digits_ = reversed(index);
  dimension_ = 0;
}

double SampleSequence::next() {
  const std::uint32_t within = dimension_ % dimensions;
  if (within == 0) {
    group_key_ = mixed(key_ + golden * (dimension_ / dimensions + 1));
    shuffled_ = reversed(scrambled(index_digits_, static_cast<std::uint32_t>(group_key_)));
  }
  ++dimension_;
  const auto seed = static_cast<std::uint32_t>(mixed(group_key_ + golden * (within + 1)));
  // the middle of a cell of 2^-32: never 0, and free of bias
  return (reversed(scrambled(sobol_digits(shuffled_, within), seed)) + 0.5) * 0x1p-32;
}

Eigen::Vector2d SampleSequence::next_2d() {
  dimension_ += dimension_ % 2;
  const double x = next();
  return {x, next()};
}

Eigen::Vector3d SampleSequence::next_3d() {
  dimension_ = (dimension_ + dimensions - 1) / dimensions * dimensions;
  const double y = next(), z = next();
  return {next(), y, z};
}

}  // namespace scan::synth
