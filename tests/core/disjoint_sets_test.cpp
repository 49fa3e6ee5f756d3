// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/disjoint_sets.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace scan {
namespace {

TEST(DisjointSets, AreAloneAtFirst) {
  DisjointSets sets(3);
  for (std::uint32_t i = 0; i < sets.size(); ++i) EXPECT_EQ(sets.name_of(i), i);
}

// The least label floods over the pairs until nothing changes: another way to the same sets.
TEST(DisjointSets, HangTogetherAsTheLeastLabelsSay) {
  constexpr std::uint32_t count = 300;
  std::mt19937 random(5);
  std::uniform_int_distribution<std::uint32_t> any(0, count - 1);
  std::vector<std::array<std::uint32_t, 2>> pairs(200);
  for (auto& pair : pairs) pair = {any(random), any(random)};
  DisjointSets sets(count);
  std::vector<std::uint32_t> least(count);
  std::iota(least.begin(), least.end(), 0u);
  for (const auto& [i, j] : pairs) sets.unite(i, j);
  for (std::uint32_t round = 0; round < count; ++round)
    for (const auto& [i, j] : pairs) least[i] = least[j] = std::min(least[i], least[j]);
  for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(sets.name_of(i), least[i]);
}

}  // namespace
}  // namespace scan
