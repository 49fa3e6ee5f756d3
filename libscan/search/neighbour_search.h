// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Neighbour search: one concept, five models, the same answers.
//
// Answers are decided in double precision, by squared_distance_m2: to the bit those of a loop over
// all points. Among equally near points the lowest index comes first. Points that are not finite
// are never returned, and a query that is not finite finds nothing. Many queries at once: batch.h.
//
// To add a model: 1. a class that satisfies the concept; 2. its name in SearchMethod and AnySearch;
// 3. nothing more: search_test.cpp walks the variant against brute force.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace scan {

struct Neighbour {
  std::uint32_t index = 0;
  double distance2_m2 = 0;
  friend bool operator==(const Neighbour&, const Neighbour&) = default;
};

// Stands for no point where an index is expected.
inline constexpr std::uint32_t no_point = std::numeric_limits<std::uint32_t>::max();

// `nearest`: within max_distance_m (inclusive), or none. `guess` is the index of a point thought to
// be near, or anything else: it changes the time only, never the answer. The neighbour that the
// query had before a small motion saves a part of the search; `k_nearest` takes one, too.
// `k_nearest`: up to k, `within`: all within the radius (inclusive); both sorted by (distance,
// index) and written over `found`. All are safe to call from many threads. `size` counts the finite
// points.
template <class S>
concept NeighbourSearch = requires(const S& search, const Eigen::Vector3d& query, std::size_t k,
                                   double distance_m, std::uint32_t guess,
                                   std::vector<Neighbour>& found) {
  { search.size() } -> std::convertible_to<std::size_t>;
  { search.nearest(query, distance_m) } -> std::same_as<std::optional<Neighbour>>;
  { search.nearest(query, distance_m, guess) } -> std::same_as<std::optional<Neighbour>>;
  { search.k_nearest(query, k, found) } -> std::same_as<void>;
  { search.k_nearest(query, k, found, guess) } -> std::same_as<void>;
  { search.within(query, distance_m, found) } -> std::same_as<void>;
};

// The order of answers: by distance, then by index.
inline bool nearer(const Neighbour& a, const Neighbour& b) {
  return a.distance2_m2 < b.distance2_m2 || (a.distance2_m2 == b.distance2_m2 && a.index < b.index);
}

// The squared distance by which all models decide; one order of operations, so the same bits.
inline double squared_distance_m2(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double x = a.x() - b.x(), y = a.y() - b.y(), z = a.z() - b.z();
  return x * x + y * y + z * z;
}

inline constexpr double unlimited_m = std::numeric_limits<double>::infinity();

}  // namespace scan
