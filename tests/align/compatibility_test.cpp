// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/compatibility.h"

#include <gtest/gtest.h>

#include "libscan/core/parallel.h"
#include "tests/align/test_clouds.h"

namespace scan {
namespace {

using test::random_direction;

std::vector<Correspondence> random_correspondences(std::size_t count, std::uint64_t seed) {
  std::vector<Correspondence> all(count);
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(seed, 0, i);
    all[i].source = random_direction(random);
    all[i].target = random_direction(random);
    all[i].source_normal = random_direction(random);
    all[i].target_normal = random_direction(random);
  }
  return all;
}

// How far a pair is from the border between agreeing and not; negative: it agrees.
double beyond(const Correspondence& a, const Correspondence& b, const CompatibilityLimits& limits) {
  const double s = (a.source - b.source).norm(), t = (a.target - b.target).norm();
  const double turn =
      std::abs(a.source_normal.dot(b.source_normal) - a.target_normal.dot(b.target_normal));
  return std::max({std::abs(s - t) - limits.distance_m, limits.least_distance_m - std::min(s, t),
                   turn - limits.cosine});
}

// Against the definition in double precision, in sizes about a tile of 64. Squared distances of
// size 4 are rounded to 4 * 2^-24 some ten times, which is 1e-5 in a distance above 0.05.
TEST(Compatibility, IsWhatItsDefinitionSays) {
  for (const double cosine : {2.0, 0.3})
    for (const std::size_t count : {1, 2, 63, 64, 65, 128, 200}) {
      const auto all = random_correspondences(count, count);
      const CompatibilityLimits limits{0.1, 0.3, cosine};
      const BitGraph graph = compatibility(all, limits);
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j) {
          EXPECT_EQ(graph.has(i, j), graph.has(j, i));
          const double off = i == j ? 1 : beyond(all[i], all[j], limits);
          EXPECT_TRUE(std::abs(off) < 1e-5 || graph.has(i, j) == (off < 0)) << i << " " << j;
        }
    }
}

TEST(Compatibility, BitsBeyondTheLastNodeAreZero) {
  const std::vector<Correspondence> all(70);
  const BitGraph graph = compatibility(all, {.distance_m = 1});
  EXPECT_EQ(graph.degree(0), 0u);  // all in one place: no extent
  const auto random = random_correspondences(70, 1);
  const BitGraph full = compatibility(random, {.distance_m = 10});
  for (std::size_t i = 0; i < 70; ++i) EXPECT_EQ(full.degree(i), 69u);
}

// Scale and offset leave the graph as it is: it is made about the middle, in units of the extent.
TEST(Compatibility, ScaleAndOffsetChangeNothing) {
  const auto all = random_correspondences(150, 3);
  const BitGraph graph = compatibility(all, {.distance_m = 0.1});
  for (const double scale : {0x1p-20, 0x1p20}) {
    auto moved = all;
    for (Correspondence& one : moved) one.source *= scale, one.target *= scale;
    const BitGraph other = compatibility(moved, {.distance_m = 0.1 * scale});
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_TRUE(std::equal(graph.row(i).begin(), graph.row(i).end(), other.row(i).begin()));
  }
}

TEST(Compatibility, IsTheSameForAnyNumberOfThreads) {
  const auto all = random_correspondences(700, 3);
  std::vector<std::vector<std::uint64_t>> rows;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    const BitGraph graph = compatibility(all, {.distance_m = 0.1});
    rows.emplace_back();
    for (std::size_t i = 0; i < graph.size(); ++i)
      rows.back().insert(rows.back().end(), graph.row(i).begin(), graph.row(i).end());
  }
  EXPECT_EQ(rows[0], rows[1]);
  EXPECT_EQ(rows[0], rows[2]);
}

TEST(BitGraph, JoinsBothWays) {
  BitGraph graph(130);
  graph.join(1, 129);
  EXPECT_TRUE(graph.has(1, 129));
  EXPECT_TRUE(graph.has(129, 1));
  EXPECT_EQ(graph.degree(1), 1u);
  std::vector<std::size_t> bits;
  for_each_bit(graph.row(1), [&](std::size_t i) { bits.push_back(i); });
  EXPECT_EQ(bits, std::vector<std::size_t>{129});
}

}  // namespace
}  // namespace scan
