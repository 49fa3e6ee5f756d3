// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Neighbour search by FLANN's exact single kd-tree.
#pragma once

#include <memory>

#include "libscan/search/neighbour_search.h"

namespace scan {

// Models NeighbourSearch.
class FlannIndex {
 public:
  explicit FlannIndex(std::span<const Eigen::Vector3d> points);
  ~FlannIndex();
  FlannIndex(FlannIndex&&) noexcept;
  FlannIndex& operator=(FlannIndex&&) noexcept;

  std::size_t size() const;
  std::optional<Neighbour> nearest(const Eigen::Vector3d& query,
                                   double max_distance_m = unlimited_m,
                                   std::uint32_t guess = no_point) const;
  void k_nearest(const Eigen::Vector3d& query, std::size_t k, std::vector<Neighbour>& found,
                 std::uint32_t guess = no_point) const;
  void within(const Eigen::Vector3d& query, double radius_m, std::vector<Neighbour>& found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

static_assert(NeighbourSearch<FlannIndex>);

}  // namespace scan
