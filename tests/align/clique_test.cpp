// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/clique.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr std::uint64_t enough = 1'000'000'000;

BitGraph random_graph(std::size_t size, double density, std::uint64_t seed) {
  BitGraph graph(size);
  RandomStream random(seed, 0, 0);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (random.uniform() < density) graph.join(i, j);
  return graph;
}

// By trying every set that can still grow: slow and plain.
std::size_t largest_by_trying(const BitGraph& graph, std::vector<std::size_t> candidates) {
  std::size_t best = 0;
  while (!candidates.empty()) {
    const std::size_t first = candidates.back();
    candidates.pop_back();
    std::vector<std::size_t> inner;
    for (const std::size_t other : candidates)
      if (graph.has(first, other)) inner.push_back(other);
    best = std::max(best, 1 + largest_by_trying(graph, inner));
  }
  return best;
}

void expect_clique(const BitGraph& graph, const std::vector<std::uint32_t>& members) {
  for (const std::uint32_t i : members)
    for (const std::uint32_t j : members) EXPECT_TRUE(i == j || graph.has(i, j)) << i << " " << j;
}

TEST(LargestClique, IsTheOneFoundByTryingAll) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::size_t size = 5 + seed;
    const double density = 0.1 + 0.02 * double(seed);
    const BitGraph graph = random_graph(size, density, seed);
    std::vector<std::size_t> all(size);
    for (std::size_t i = 0; i < size; ++i) all[i] = i;
    const Clique clique = largest_clique(graph, {}, enough);
    expect_clique(graph, clique.members);
    EXPECT_EQ(clique.members.size(), largest_by_trying(graph, all)) << seed;
    EXPECT_EQ(clique.upper_bound, clique.members.size()) << seed;
  }
}

TEST(LargestClique, PlantedOneIsFoundAndProved) {
  BitGraph graph = random_graph(400, 0.1, 1);
  for (std::size_t i = 0; i < 400; i += 20)
    for (std::size_t j = 0; j < i; j += 20) graph.join(i, j);
  const Clique clique = largest_clique(graph, {}, enough);
  EXPECT_GE(clique.members.size(), 20u);
  EXPECT_EQ(clique.upper_bound, clique.members.size());
}

TEST(LargestClique, KnownOneIsKeptUnlessBeaten) {
  BitGraph graph(10);
  graph.join(2, 5);
  graph.join(7, 8);
  const Clique same = largest_clique(graph, {2, 5}, enough);
  EXPECT_EQ(same.members, (std::vector<std::uint32_t>{2, 5}));
  EXPECT_EQ(same.upper_bound, 2u);
  graph.join(7, 9);
  graph.join(8, 9);
  EXPECT_EQ(largest_clique(graph, {2, 5}, enough).members, (std::vector<std::uint32_t>{7, 8, 9}));
}

// Out of budget: what is said stays true, the gap is stated.
TEST(LargestClique, BoundHoldsWhenTheBudgetEnds) {
  const BitGraph graph = random_graph(120, 0.7, 3);
  const Clique exact = largest_clique(graph, {}, enough);
  ASSERT_EQ(exact.upper_bound, exact.members.size());
  bool gap = false;
  for (const std::uint64_t budget : {0u, 100u, 1000u, 10000u, 100000u}) {
    const Clique early = largest_clique(graph, {}, budget);
    expect_clique(graph, early.members);
    EXPECT_LE(early.members.size(), exact.members.size());
    EXPECT_GE(early.upper_bound, exact.members.size());
    gap |= early.upper_bound > early.members.size();
  }
  EXPECT_TRUE(gap);
}

TEST(LargestClique, OfNothingIsNothing) {
  EXPECT_TRUE(largest_clique(BitGraph(0), {}, enough).members.empty());
  EXPECT_EQ(largest_clique(BitGraph(1), {}, enough).members.size(), 1u);
}

TEST(GreedyClique, HoldsItsSeedAndCannotGrow) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const BitGraph graph = random_graph(100, 0.3, seed);
    const auto first = std::uint32_t(seed * 5);
    const auto clique = greedy_clique(graph, first);
    expect_clique(graph, clique);
    const std::set<std::uint32_t> members(clique.begin(), clique.end());
    EXPECT_TRUE(members.contains(first));
    for (std::uint32_t i = 0; i < 100; ++i)
      EXPECT_TRUE(members.contains(i) ||
                  std::any_of(clique.begin(), clique.end(),
                              [&](std::uint32_t j) { return !graph.has(i, j); }));
  }
}

}  // namespace
}  // namespace scan
