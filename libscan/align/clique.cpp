// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/clique.h"

#include <algorithm>

#include "libscan/align/bit_kernels.h"

namespace scan {
namespace {

using Bits = std::vector<std::uint64_t>;

std::size_t common(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) {
  return common_bits(a.data(), b.data(), a.size());
}

// Nodes that may be in a clique of more than `known`: those with as many neighbours among
// themselves (the k-core).
Bits core(const BitGraph& graph, std::size_t known) {
  Bits alive(graph.words(), 0);
  for (std::size_t i = 0; i < graph.size(); ++i) alive[i / 64] |= std::uint64_t{1} << (i % 64);
  for (bool changed = true; changed;) {
    changed = false;
    for_each_bit(Bits(alive), [&](std::size_t i) {
      if (common(alive, graph.row(i)) >= known) return;
      alive[i / 64] &= ~(std::uint64_t{1} << (i % 64));
      changed = true;
    });
  }
  return alive;
}

class Search {
 public:
  Search(const BitGraph& graph, std::size_t known, std::uint64_t budget)
      : graph_(graph), best_size_(known), budget_(budget) {}

  // Returns the bound; `best` holds a larger clique than the known one, or nothing.
  std::size_t run(Bits candidates) { return expand(std::move(candidates)); }
  const std::vector<std::uint32_t>& best() const { return best_; }

 private:
  struct Coloured {
    std::uint32_t node;
    std::size_t colour;  // 1, 2, ...; no clique among this and those before it is larger
  };

  std::vector<Coloured> colour(Bits rest) {
    std::vector<Coloured> order;
    Bits free(rest.size());
    for (std::size_t colour = 1;; ++colour) {
      free = rest;
      bool any = false;
      for (std::size_t word = 0; word < free.size(); ++word)
        while (free[word] != 0) {
          any = true;
          const auto bit = static_cast<std::size_t>(std::countr_zero(free[word]));
          const std::size_t node = 64 * word + bit;
          rest[word] &= ~(std::uint64_t{1} << bit);
          free[word] &= ~(std::uint64_t{1} << bit);
          const auto row = graph_.row(node);
          for (std::size_t k = word; k < free.size(); ++k) free[k] &= ~row[k];
          spent_ += free.size() - word;
          order.push_back({static_cast<std::uint32_t>(node), colour});
        }
      if (!any) return order;
      spent_ += free.size();
    }
  }

  // The largest size that a clique of `current_` and `candidates` can have.
  std::size_t expand(Bits candidates) {
    const std::vector<Coloured> order = colour(candidates);
    if (order.empty()) {
      if (current_.size() > best_size_) best_ = current_, best_size_ = current_.size();
      return current_.size();
    }
    for (auto next = order.rbegin(); next != order.rend(); ++next) {
      const std::size_t bound = current_.size() + next->colour;
      if (bound <= best_size_) return best_size_;
      if (spent_ > budget_) return bound;
      Bits inner(candidates.size());
      const auto row = graph_.row(next->node);
      for (std::size_t k = 0; k < inner.size(); ++k) inner[k] = candidates[k] & row[k];
      spent_ += inner.size();
      current_.push_back(next->node);
      const std::size_t reached = expand(std::move(inner));
      current_.pop_back();
      if (spent_ > budget_) return std::max({best_size_, reached, bound});
      candidates[next->node / 64] &= ~(std::uint64_t{1} << (next->node % 64));
    }
    return best_size_;
  }

  const BitGraph& graph_;
  std::size_t best_size_;
  std::uint64_t budget_, spent_ = 0;
  std::vector<std::uint32_t> current_, best_;
};

}  // namespace

std::vector<std::uint32_t> greedy_clique(const BitGraph& graph, std::uint32_t seed) {
  const auto row = graph.row(seed);
  struct Ranked {
    std::uint32_t node;
    std::size_t shared;
  };
  std::vector<Ranked> ranked;
  for_each_bit(row, [&](std::size_t i) {
    ranked.push_back({static_cast<std::uint32_t>(i), common(row, graph.row(i))});
  });
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.shared > b.shared; });
  std::vector<std::uint32_t> clique{seed};
  Bits left(row.begin(), row.end());
  for (const Ranked& next : ranked) {
    if (!(left[next.node / 64] >> (next.node % 64) & 1)) continue;
    clique.push_back(next.node);
    const auto others = graph.row(next.node);
    for (std::size_t k = 0; k < left.size(); ++k) left[k] &= others[k];
  }
  std::sort(clique.begin(), clique.end());
  return clique;
}

Clique largest_clique(const BitGraph& graph, std::vector<std::uint32_t> known,
                      std::uint64_t most_word_operations) {
  Clique result{std::move(known), 0};
  Search search(graph, result.members.size(), most_word_operations);
  result.upper_bound =
      std::max(search.run(core(graph, result.members.size())), result.members.size());
  if (!search.best().empty()) {
    result.members = search.best();
    std::sort(result.members.begin(), result.members.end());
  }
  return result;
}

}  // namespace scan
