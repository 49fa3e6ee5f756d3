// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/random_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "libscan/core/random.h"
#include "tests/core/chi_square.h"

namespace scan {
namespace {

// Addresses beyond 32 bits, in an order of their own.
std::vector<BlockAddress> scattered_blocks(std::size_t count) {
  std::vector<BlockAddress> blocks;
  for (std::size_t i = 0; i < count; ++i)
    blocks.push_back({0xFFFFFFF0u + 7919 * i % 41, (0xFFFFFFFFu - i * 13) & 0xFFFFFFFFu});
  return blocks;
}

std::vector<BlockAddress> first_blocks_of_rays(std::size_t count) {
  std::vector<BlockAddress> blocks;
  for (std::size_t i = 0; i < count; ++i) blocks.push_back({i, 0});
  return blocks;
}

std::vector<BlockAddress> stream_of_a_ray(std::size_t count) {
  std::vector<BlockAddress> blocks;
  for (std::size_t i = 0; i < count; ++i) blocks.push_back({3, i});
  return blocks;
}

std::vector<float> normals_of(const std::vector<BlockAddress>& blocks) {
  std::vector<float> normals(4 * blocks.size());
  draw_normals(1, 2, blocks, normals);
  return normals;
}

TEST(RandomBlocks, AreThoseOfTheStreams) {
  const auto blocks = scattered_blocks(37);
  std::vector<std::uint32_t> words(4 * blocks.size());
  draw_words(0x123456789ABCDEFull, 77, blocks, words);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    RandomStream stream(0x123456789ABCDEFull, 77, blocks[i].ray,
                        static_cast<std::uint32_t>(blocks[i].block));
    for (std::size_t j = 0; j < 4; ++j) EXPECT_EQ(words[4 * i + j], stream.bits32()) << i;
  }
}

// Box and Muller's formulas in the C library's functions. In floats the radius's square s is off by
// e = 2 * 2^-24 (m's rounding) and 5 roundings of itself, 3e-7 s, so the radius by e / sqrt(s) or,
// near 0, sqrt(e), and 1.5e-7 of itself; the turn by 5 roundings, 3e-7; 1.5e-7 for the product.
TEST(RandomBlocks, GiveTheNormalNumbersOfTheirWords) {
  const auto blocks = scattered_blocks(20'000);
  std::vector<std::uint32_t> words(4 * blocks.size());
  draw_words(1, 2, blocks, words);
  const std::vector<float> normals = normals_of(blocks);
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const double radius = std::sqrt(-2 * std::log((words[i] + 0.5) * 0x1p-32));
    const double off = 6e-7 * radius + std::min(1.2e-7 / radius, 3.5e-4);
    // the first quarter's angles are centred on 0
    const double angle = 2 * std::numbers::pi * ((words[i + 1] + 0.5) * 0x1p-32 - 0.125);
    ASSERT_NEAR(normals[i], radius * std::cos(angle), off) << i;
    ASSERT_NEAR(normals[i + 1], radius * std::sin(angle), off) << i;
  }
}

TEST(RandomBlocks, DoNotDependOnThoseDrawnWithThem) {
  const auto blocks = scattered_blocks(100);
  const std::vector<float> together = normals_of(blocks);
  for (const std::size_t count : {1u, 2u, 15u, 16u, 17u})
    for (std::size_t i = 0; i + count <= blocks.size(); i += count) {
      const auto some = normals_of({blocks.begin() + static_cast<std::ptrdiff_t>(i),
                                    blocks.begin() + static_cast<std::ptrdiff_t>(i + count)});
      ASSERT_EQ(std::memcmp(some.data(), &together[4 * i], some.size() * sizeof(float)), 0);
    }
}

TEST(RandomBlocks, GiveTheSameBytesByEveryKernel) {
  const auto blocks = scattered_blocks(4099);
  std::vector<float> plain(4 * blocks.size()), other(plain.size());
  normals_kernels().front()(5, 6, blocks.data(), blocks.size(), plain.data());
  for (NormalsKernel* const kernel : normals_kernels()) {
    kernel(5, 6, blocks.data(), blocks.size(), other.data());
    EXPECT_EQ(std::memcmp(plain.data(), other.data(), plain.size() * sizeof(float)), 0);
  }
}

// Two million draws along a stream, and over the first blocks of many rays.
TEST(RandomBlocks, HaveTheNormalDistribution) {
  for (const auto& normals :
       {normals_of(stream_of_a_ray(500'000)), normals_of(first_blocks_of_rays(500'000))}) {
    std::size_t next = 0;
    const auto probability = [&] { return 0.5 * std::erfc(-normals[next++] / std::sqrt(2)); };
    EXPECT_LT(uniformity_score(probability, normals.size()), one_in_a_million);
  }
}

// Of n draws the sum of x^k has the mean n E x^k and the variance n (E x^2k - (E x^k)^2); 5
// standard deviations each.
TEST(RandomBlocks, HaveTheNormalMoments) {
  const std::vector<float> normals = normals_of(first_blocks_of_rays(500'000));
  const double n = static_cast<double>(normals.size());
  const double mean[] = {0, 1, 0, 3}, of_squares[] = {1, 3, 15, 105};
  for (int k = 1; k <= 4; ++k) {
    double sum = 0;
    for (const double x : normals) sum += std::pow(x, k);
    const double variance = of_squares[k - 1] - mean[k - 1] * mean[k - 1];
    EXPECT_NEAR(sum / n, mean[k - 1], 5 * std::sqrt(variance / n)) << k;
  }
}

// P(|x| > 4.5) = 6.795e-6: 13.6 of two million, counted to 5 standard deviations.
TEST(RandomBlocks, HaveTheNormalTails) {
  const std::vector<float> normals = normals_of(first_blocks_of_rays(500'000));
  double beyond_3 = 0, beyond_4 = 0, n = static_cast<double>(normals.size());
  for (const double x : normals) {
    beyond_3 += std::abs(x) > 3;
    beyond_4 += std::abs(x) > 4;
  }
  const double expected_3 = n * std::erfc(3 / std::sqrt(2)),
               expected_4 = n * std::erfc(4 / std::sqrt(2));
  EXPECT_NEAR(beyond_3, expected_3, 5 * std::sqrt(expected_3));
  EXPECT_NEAR(beyond_4, expected_4, 5 * std::sqrt(expected_4));
}

// The four numbers of a block and the next block's first: each pair's correlation times sqrt(n) is
// normal, and so is that of their squares.
TEST(RandomBlocks, GiveIndependentNumbers) {
  const std::vector<float> normals = normals_of(stream_of_a_ray(250'000));
  const double n = static_cast<double>(normals.size() / 4 - 1);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 5; ++b) {
      double product = 0, squares = 0;
      for (std::size_t i = 0; i + 4 < normals.size(); i += 4) {
        const double x = normals[i + a], y = normals[i + b];
        product += x * y;
        squares += (x * x - 1) * (y * y - 1) / 2;
      }
      EXPECT_LT(std::abs(product) / std::sqrt(n), 5) << a << b;
      EXPECT_LT(std::abs(squares) / std::sqrt(n), 5) << a << b;
    }
}

}  // namespace
}  // namespace scan
