// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The generator against published vectors, the distributions by chi-square.
//
// Seeds are fixed, so a passing test passes for ever; the stated significance is the chance that a
// right generator would have failed for the seed chosen.
#include "libscan/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/core/chi_square.h"

namespace scan {
namespace {

// Known answers of Philox4x32-10 from the authors' test vectors (Salmon et al. 2011, Random123
// kat).
TEST(Philox, GivesThePublishedBlocks) {
  using Block = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(ChiSquareScore, SeesATiltOfOnePerCent) {
  RandomStream random(1, 0, 0);
  // density 1 + 0.01 cos(2 pi u), by rejection: 400000 draws shift chi-square by 20 = 1 sd; 5 %
  // shift it by 500 = 25 sd. So 5 % must be seen.
  const auto tilted = [&] {
    while (true) {
      const double u = random.uniform();
      if (random.uniform() * 1.05 < 1 + 0.05 * std::cos(2 * std::numbers::pi * u)) return u;
    }
  };
  EXPECT_GT(uniformity_score(tilted), one_in_a_million);
}

TEST(Uniform, IsUniformAlongAStream) {
  RandomStream random(1, 2, 3);
  EXPECT_LT(uniformity_score([&] { return random.uniform(); }), one_in_a_million);
}

TEST(Uniform, IsUniformOverTheFirstDrawsOfManyRays) {
  std::uint64_t ray = 0;
  EXPECT_LT(uniformity_score([&] { return RandomStream(1, 2, ray++).uniform(); }),
            one_in_a_million);
}

TEST(Uniform, StaysBelowOne) {
  RandomStream random(4, 0, 0);
  for (int i = 0; i < 100'000; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
  }
}

TEST(Normal, HasTheNormalDistribution) {
  RandomStream random(1, 2, 4);
  const auto probability = [&] { return 0.5 * std::erfc(-random.normal() / std::numbers::sqrt2); };
  EXPECT_LT(uniformity_score(probability), one_in_a_million);
}

// Both numbers of a Box-Muller pair: their correlation times sqrt(n) is normal.
TEST(Normal, PairsAreUncorrelated) {
  RandomStream random(1, 2, 5);
  constexpr int count = 200'000;
  double product = 0, square_product = 0;
  for (int i = 0; i < count; ++i) {
    const double a = random.normal(), b = random.normal();
    product += a * b;
    square_product += (a * a - 1) * (b * b - 1) / 2;
  }
  EXPECT_LT(std::abs(product) / std::sqrt(count), 5);
  EXPECT_LT(std::abs(square_product) / std::sqrt(count), 5);
}

// Correlation of first draws at addresses one apart, in standard deviations.
double neighbour_score(std::uint64_t seed_step, std::uint32_t scan_step, std::uint64_t ray_step) {
  constexpr std::uint32_t count = 100'000;
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double a = RandomStream(i, i, i).uniform() - 0.5;
    const double b = RandomStream(i + seed_step, i + scan_step, i + ray_step).uniform() - 0.5;
    sum += 12 * a * b;  // variance of a * b is 1 / 144
  }
  return std::abs(sum) / std::sqrt(count);
}

// |score| > 5 has probability 6e-7 for independent streams.
TEST(RandomStream, NeighbouringAddressesAreUncorrelated) {
  EXPECT_LT(neighbour_score(1, 0, 0), 5);
  EXPECT_LT(neighbour_score(0, 1, 0), 5);
  EXPECT_LT(neighbour_score(0, 0, 1), 5);
  EXPECT_LT(neighbour_score(std::uint64_t{1} << 32, 0, 0), 5);
  EXPECT_LT(neighbour_score(0, 0, std::uint64_t{1} << 32), 5);
  EXPECT_GT(neighbour_score(0, 0, 0), 5);  // the same address: the score sees it
}

TEST(RandomStream, BeginsAtTheBlockThatIsAskedFor) {
  RandomStream whole(9, 8, 7), later(9, 8, 7, 5);
  for (int i = 0; i < 4 * 5; ++i) whole.bits32();
  for (int i = 0; i < 100; ++i) EXPECT_EQ(later.bits32(), whole.bits32());
}

TEST(RandomStream, SameAddressGivesSameStream) {
  RandomStream a(9, 8, 7), b(9, 8, 7);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.bits32(), b.bits32());
}

double poisson_probability(double k, double mean) {
  return std::exp(k * std::log(mean) - mean - std::lgamma(k + 1));
}

class Poisson : public testing::TestWithParam<double> {};

// Bins of equal width, about 1/8 of a standard deviation, merged until 50 counts are expected.
TEST_P(Poisson, HasThePoissonDistribution) {
  const double mean = GetParam(), sd = std::sqrt(mean), count = 200'000;
  const double width = std::max(1.0, std::floor(sd / 8));
  const double low = std::max(0.0, std::floor(mean - 7 * sd));
  std::vector<double> upper_edges, expected;
  double mass = 0, sum = 0;
  for (double k = low; k < mean + 7 * sd + 8; ++k) {
    mass += count * poisson_probability(k, mean);
    sum += poisson_probability(k, mean);
    const bool at_edge = std::fmod(k - low + 1, width) == 0;
    if (!at_edge || mass < 50) continue;
    upper_edges.push_back(k);
    expected.push_back(std::exchange(mass, 0));
  }
  expected.back() += mass;
  ASSERT_NEAR(sum, 1, 1e-8);  // the probabilities themselves; lgamma(1e6) rounds at 1e-9
  std::vector<double> observed(expected.size(), 0);
  RandomStream random(11, 0, 0);
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<double>(random.poisson(mean));
    const auto bin = std::lower_bound(upper_edges.begin(), upper_edges.end(), k);
    observed[std::min<std::size_t>(bin - upper_edges.begin(), observed.size() - 1)] += 1;
  }
  EXPECT_LT(chi_square_score(observed, expected), one_in_a_million);
}

INSTANTIATE_TEST_SUITE_P(Means, Poisson, testing::Values(0.1, 5, 11.9, 12, 100, 1e6));

TEST(Poisson, OfMeanZeroIsZero) {
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.poisson(0), 0u);
}

// Mean and variance of 1e4 draws: the sample mean has the standard deviation sqrt(mean / n), the
// sample variance sqrt(2 / n) mean; 5 standard deviations each.
TEST(Poisson, KeepsItsMomentsForEnormousMeans) {
  for (const double mean : {1e9, 1e12, 1e15}) {
    RandomStream random(12, 0, 0);
    constexpr int count = 10'000;
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
      const double deviation = (static_cast<double>(random.poisson(mean)) - mean) / std::sqrt(mean);
      sum += deviation;
      squares += deviation * deviation;
    }
    EXPECT_LT(std::abs(sum) / std::sqrt(count), 5) << mean;
    EXPECT_NEAR(squares / count, 1, 5 * std::sqrt(2.0 / count)) << mean;
  }
}

}  // namespace
}  // namespace scan
