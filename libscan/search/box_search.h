// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What KdTree and Octree have in common: the search in a tree of boxes.
#pragma once

#include <memory>

#include "libscan/search/neighbour_search.h"

namespace scan {

struct BoxTree;

// Models NeighbourSearch. A guess (neighbour_search.h) tells where to look first.
class BoxSearch {
 public:
  explicit BoxSearch(BoxTree&& tree);
  ~BoxSearch();
  BoxSearch(BoxSearch&&) noexcept;
  BoxSearch& operator=(BoxSearch&&) noexcept;

  std::size_t size() const;
  std::optional<Neighbour> nearest(const Eigen::Vector3d& query,
                                   double max_distance_m = unlimited_m,
                                   std::uint32_t guess = no_point) const;
  void k_nearest(const Eigen::Vector3d& query, std::size_t k, std::vector<Neighbour>& found) const;
  void within(const Eigen::Vector3d& query, double radius_m, std::vector<Neighbour>& found) const;

 private:
  std::unique_ptr<BoxTree> tree_;
};

static_assert(NeighbourSearch<BoxSearch>);

}  // namespace scan
