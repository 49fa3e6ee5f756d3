// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/sampling/sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "libscan/core/random.h"
#include "tests/synth/goodness.h"

namespace scan::synth {
namespace {

constexpr int dimensions = 12;  // three groups

// Points [first, first + count) of a sequence, each of 12 numbers.
std::vector<std::vector<double>> points(SampleSequence sequence, std::uint32_t first, int count) {
  std::vector<std::vector<double>> all(count, std::vector<double>(dimensions));
  for (int i = 0; i < count; ++i) {
    sequence.start(first + i);
    for (double& x : all[i]) x = sequence.next();
  }
  return all;
}

// Every interval of 2^-a by 2^-b of the unit square holds as many points as its area asks for.
bool fills_intervals(const std::vector<std::vector<double>>& all, int first, int second, int a,
                     int b) {
  std::vector<int> counts(std::size_t{1} << (a + b), 0);
  for (const auto& point : all) {
    const auto column = static_cast<std::size_t>(std::ldexp(point[first], a));
    const auto row = static_cast<std::size_t>(std::ldexp(point[second], b));
    ++counts[row << a | column];
  }
  for (const int count : counts)
    if (count != static_cast<int>(all.size() / counts.size())) return false;
  return true;
}

// Least t for which the points are a (t, m, 2)-net in these dimensions.
int net_quality(const std::vector<std::vector<double>>& all, int first, int second, int m) {
  for (int t = 0; t < m; ++t) {
    bool holds = true;
    for (int a = 0; a <= m - t; ++a)
      holds = holds && fills_intervals(all, first, second, a, m - t - a);
    if (holds) return t;
  }
  return m;
}

TEST(SampleSequence, EachDimensionIsStratified) {
  for (std::uint64_t ray = 0; ray < 4; ++ray)
    for (const int m : {1, 4, 7, 10})
      for (const std::uint32_t block : {0u, 1u, 5u}) {
        const auto all = points({1, 2, ray, 3}, block << m, 1 << m);
        for (int d = 0; d < dimensions; ++d)
          EXPECT_TRUE(fills_intervals(all, d, d, m, 0)) << d << " of 2^" << m;
      }
}

TEST(SampleSequence, TheFirstPairOfEachGroupIsANet) {
  for (std::uint64_t ray = 0; ray < 4; ++ray)
    for (int m = 1; m <= 10; ++m) {
      const auto all = points({1, 2, ray, 3}, 0, 1 << m);
      for (int d = 0; d < dimensions; d += 4)
        EXPECT_EQ(net_quality(all, d, d + 1, m), 0) << d << " of 2^" << m;
    }
}

TEST(SampleSequence, OtherPairsOfAGroupAreNearlyNets) {
  // t of a pair is at most the sum of its polynomials' degrees, each less one (Sobol' 1967), where
  // van der Corput's dimension counts 0
  const int degree[] = {1, 1, 2, 3};
  for (std::uint64_t ray = 0; ray < 2; ++ray)
    for (int m = 1; m <= 10; ++m) {
      const auto all = points({4, 2, ray, 3}, 0, 1 << m);
      for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b)
          EXPECT_LE(net_quality(all, 4 + a, 4 + b, m), degree[a] + degree[b] - 2)
              << a << " " << b << " of 2^" << m;
    }
}

TEST(SampleSequence, SixteenPointsVisitSixteenOrthants) {
  // Sobol's property A: the first 2^d points lie one in each orthant of d dimensions
  for (std::uint64_t ray = 0; ray < 8; ++ray)
    for (int group = 0; group < dimensions; group += 4) {
      std::set<int> orthants;
      for (const auto& point : points({9, 9, ray, 9}, 0, 16)) {
        int orthant = 0;
        for (int d = 0; d < 4; ++d) orthant |= (point[group + d] >= 0.5) << d;
        orthants.insert(orthant);
      }
      EXPECT_EQ(orthants.size(), 16u);
    }
}

// Root mean square error over independent streams of the mean of a smooth function of (x, y).
double error_of_mean(int count, bool random_numbers) {
  const double truth = std::pow(std::sin(1.0) + 1, 2);  // of (cos x + 2 x)(cos y + 2 y)
  const int streams = 128;
  double squares = 0;
  for (int stream = 0; stream < streams; ++stream) {
    SampleSequence sequence(11, 0, 0, stream);
    RandomStream random(11, 0, stream);
    double sum = 0;
    for (int i = 0; i < count; ++i) {
      sequence.start(i);
      Eigen::Vector2d p = sequence.next_2d();
      if (random_numbers) {
        p.x() = random.uniform();
        p.y() = random.uniform();
      }
      sum += (std::cos(p.x()) + 2 * p.x()) * (std::cos(p.y()) + 2 * p.y());
    }
    squares += std::pow(sum / count - truth, 2);
  }
  return std::sqrt(squares / streams);
}

TEST(SampleSequence, ErrorsFallByThePowerOfThreeHalves) {
  // Owen 1997: N^-3/2 up to logarithms, against N^-1/2. Both errors of 128 streams have a relative
  // standard error of 1 / sqrt(256), so the exponent over 64-fold N has 0.09 / log(64) = 0.02; the
  // logarithm's half power takes at most log(log 1024 / log 16) / 2 / log(64) = 0.11 off.
  const double slope =
      std::log(error_of_mean(16, false) / error_of_mean(1024, false)) / std::log(64.0);
  EXPECT_GT(slope, 1.5 - 0.11 - 0.06);
  EXPECT_LT(slope, 1.5 + 0.11 + 0.06);
  const double plain =
      std::log(error_of_mean(16, true) / error_of_mean(1024, true)) / std::log(64.0);
  EXPECT_NEAR(plain, 0.5, 0.06);
}

TEST(SampleSequence, EachPointIsUniformOverStreams) {
  // the fourth point, its first eight numbers, each and in pairs of neighbours
  const int streams = 20000, cells = 8;
  for (int d = 0; d < 8; ++d) {
    std::vector<double> counts(cells * cells, 0.0);
    for (int stream = 0; stream < streams; ++stream) {
      const auto point = points({5, 6, 7, static_cast<std::uint32_t>(stream)}, 3, 1)[0];
      ++counts[static_cast<int>(point[d] * cells) * cells + static_cast<int>(point[d + 1] * cells)];
    }
    const std::vector<double> expected(counts.size(), static_cast<double>(streams) / counts.size());
    EXPECT_GT(goodness_of_fit(counts, expected), 1e-3 / 8) << d;
  }
}

TEST(SampleSequence, NumbersLieInTheMiddleOfTheirCells) {
  for (const auto& point : points({1, 2, 3, 4}, 0, 256))
    for (const double x : point) {
      ASSERT_GT(x, 0);
      ASSERT_LT(x, 1);
      ASSERT_EQ(std::fmod(x * 0x1p33, 2), 1) << "an odd half of 2^-32";
    }
}

TEST(SampleSequence, MeansOfAnyPrefixAreUnbiasedOverStreams) {
  // 4000 streams of 5 points: the standard error of E[x y] is below 0.29 / sqrt(20000)
  double sum = 0;
  for (std::uint32_t stream = 0; stream < 4000; ++stream)
    for (const auto& point : points({5, 1, 7, stream}, 0, 5)) sum += point[4] * point[9];
  EXPECT_NEAR(sum / 20000, 0.25, 4 * 0.29 / std::sqrt(20000.0));
}

TEST(SampleSequence, StreamsAndGroupsAreIndependent) {
  // correlation of 4096 pairs has a standard error of 1/64; 16 tests at four of them. Within a
  // sequence only numbers of different groups are compared: a net's dimensions are uncorrelated by
  // more than chance.
  const auto correlation = [](const auto& a, int i, const auto& b, int j) {
    double sum = 0;
    for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n][i] - 0.5) * (b[n][j] - 0.5);
    return 12 * sum / static_cast<double>(a.size());
  };
  const SampleSequence base(1, 1, 1, 1);
  const auto one = points(base, 0, 4096);
  for (const SampleSequence& other : {SampleSequence(2, 1, 1, 1), SampleSequence(1, 2, 1, 1),
                                      SampleSequence(1, 1, 2, 1), SampleSequence(1, 1, 1, 2)}) {
    const auto two = points(other, 0, 4096);
    for (int d = 0; d < 4; ++d) EXPECT_NEAR(correlation(one, d, two, d), 0, 4 / 64.0) << d;
  }
  for (int d = 0; d < 8; ++d) EXPECT_NEAR(correlation(one, d, one, d + 4), 0, 4 / 64.0) << d;
}

TEST(SampleSequence, DrawsOfSeveralKeepToOneGroup) {
  SampleSequence sequence(1, 2, 3, 4);
  const auto plain = points(sequence, 17, 1)[0];
  sequence.start(17);
  const Eigen::Vector3d three = sequence.next_3d();
  EXPECT_EQ(three, Eigen::Vector3d(plain[2], plain[0], plain[1]));
  EXPECT_EQ(sequence.next(), plain[3]);
  const Eigen::Vector2d two = sequence.next_2d();
  EXPECT_EQ(two, Eigen::Vector2d(plain[4], plain[5]));
  EXPECT_EQ(sequence.next(), plain[6]);
  EXPECT_EQ(sequence.next_2d(), Eigen::Vector2d(plain[8], plain[9]));
  EXPECT_EQ(sequence.next(), plain[10]);
}

TEST(SampleSequence, IsPinned) {
  // results stay reproducible over versions: a change of these numbers changes every image
  SampleSequence sequence(0x123456789abcdefull, 7, 0xfedcba9876543210ull, 2);
  sequence.start(1000003);
  std::vector<std::uint32_t> words;
  for (int i = 0; i < 5; ++i) words.push_back(static_cast<std::uint32_t>(sequence.next() * 0x1p32));
  EXPECT_EQ(words, (std::vector<std::uint32_t>{2986831804, 3677358589, 3526964347, 3663497019,
                                               415150178}));
  SampleSequence again(0x123456789abcdefull, 7, 0xfedcba9876543210ull, 2);
  again.start(1000003);
  EXPECT_EQ(static_cast<std::uint32_t>(again.next() * 0x1p32), words[0]);
}

}  // namespace
}  // namespace scan::synth
