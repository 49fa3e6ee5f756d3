// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many queries at once: on all threads, and in an order in which one finds what the last one left
// in the processor's caches. Answers are those of single queries, for any number of threads.
#pragma once

#include <algorithm>
#include <numeric>

#include "libscan/core/parallel.h"
#include "libscan/search/neighbour_search.h"

namespace scan {

// The indices of the points along a curve that fills space (Morton, 1966), so that those that
// follow one another are near one another; points that are not finite come last. A rigid motion
// changes little in how near they are: find the order once, then query as often as you like.
std::vector<std::uint32_t> curve_order(std::span<const Eigen::Vector3d> points);

inline constexpr std::size_t queries_per_task = 512;

// found[i]: the nearest point to queries[i] within max_distance_m (inclusive), or {no_point,
// infinity}. `order`: a permutation of the queries' indices, in which they are asked. If `found`
// has one entry per query when it comes in, its indices are taken for guesses: the answers of the
// iteration before, or anything else (see neighbour_search.h); else it is made as long.
template <NeighbourSearch S>
void nearest_of_each(const S& search, std::span<const Eigen::Vector3d> queries,
                     double max_distance_m, std::span<const std::uint32_t> order,
                     std::vector<Neighbour>& found) {
  constexpr Neighbour none{no_point, unlimited_m};
  found.resize(queries.size(), none);
  const auto ask = [&](std::size_t place) {
    const std::uint32_t i = order[place];
    found[i] = search.nearest(queries[i], max_distance_m, found[i].index).value_or(none);
  };
  parallel_for(queries.size(), ask, queries_per_task);
}

// found[i * m + j]: the j-th of the m = min(k, search.size()) nearest points to queries[i], sorted
// by (distance, index); {no_point, infinity} for a query that is not finite. Returns m.
template <NeighbourSearch S>
std::size_t k_nearest_of_each(const S& search, std::span<const Eigen::Vector3d> queries,
                              std::size_t k, std::span<const std::uint32_t> order,
                              std::vector<Neighbour>& found) {
  const std::size_t m = std::min<std::size_t>(k, search.size());
  found.assign(queries.size() * m, {no_point, unlimited_m});
  parallel_chunks(queries.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> mine;
    for (const std::uint32_t i : order.subspan(begin, end - begin)) {
      search.k_nearest(queries[i], m, mine);
      std::copy(mine.begin(), mine.end(), found.begin() + static_cast<std::ptrdiff_t>(i * m));
    }
  });
  return m;
}

// The neighbours of query i: found[first[i]] up to, not with, found[first[i + 1]].
struct Neighbourhoods {
  std::vector<std::size_t> first;
  std::vector<Neighbour> found;
};

// All points within the radius (inclusive) of each query, sorted by (distance, index).
template <NeighbourSearch S>
Neighbourhoods within_of_each(const S& search, std::span<const Eigen::Vector3d> queries,
                              double radius_m, std::span<const std::uint32_t> order) {
  Neighbourhoods all{std::vector<std::size_t>(queries.size() + 1, 0), {}};
  std::vector<std::vector<Neighbour>> found_by_task(queries.size() / queries_per_task + 1);
  parallel_chunks(queries.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> mine, &found = found_by_task[begin / queries_per_task];
    for (const std::uint32_t i : order.subspan(begin, end - begin)) {
      search.within(queries[i], radius_m, mine);
      all.first[i + 1] = mine.size();
      found.insert(found.end(), mine.begin(), mine.end());
    }
  });
  std::partial_sum(all.first.begin(), all.first.end(), all.first.begin());
  all.found.resize(all.first.back());
  parallel_chunks(queries.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
    const Neighbour* next = found_by_task[begin / queries_per_task].data();
    for (const std::uint32_t i : order.subspan(begin, end - begin)) {
      const std::size_t count = all.first[i + 1] - all.first[i];
      std::copy(next, next + count, all.found.data() + all.first[i]);
      next += count;
    }
  });
  return all;
}

}  // namespace scan
