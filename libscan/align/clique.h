// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The largest set of correspondences that all agree with each other, and how large it can be.
#pragma once

#include <cstdint>
#include <vector>

#include "libscan/align/compatibility.h"

namespace scan {

struct Clique {
  std::vector<std::uint32_t> members;  // rising
  std::size_t upper_bound = 0;         // no clique has more members; equal to theirs: proved
};

// A maximal clique around `seed`, which is in it: those who share most neighbours with it first.
std::vector<std::uint32_t> greedy_clique(const BitGraph& graph, std::uint32_t seed);

// Branch and bound with colourings as bounds over rows of bits (San Segundo et al. 2011), what
// cannot beat `known` (a clique) left out first (k-core). After `most_word_operations` it ends with
// the best found and a bound above it: a budget that the machine's speed does not change.
Clique largest_clique(const BitGraph& graph, std::vector<std::uint32_t> known,
                      std::uint64_t most_word_operations);

}  // namespace scan
