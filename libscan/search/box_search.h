// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What KdTree and Octree have in common: the search in a tree of boxes.
#pragma once

#include <functional>
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
  void k_nearest(const Eigen::Vector3d& query, std::size_t k, std::vector<Neighbour>& found,
                 std::uint32_t guess = no_point) const;
  void within(const Eigen::Vector3d& query, double radius_m, std::vector<Neighbour>& found) const;

  // What `within` finds in the tree's own order, which any machine has alike: of a thousand points
  // sorting takes longer than finding.
  void within_unsorted(const Eigen::Vector3d& query, double radius_m,
                       std::vector<Neighbour>& found) const;

  // The points fall into patches of neighbours. Calls body(index, found) for each point of one,
  // with what k_nearest finds for it, the point itself being one: a patch's points look into the
  // same leaves, which are found once.
  using PatchBody = std::function<void(std::uint32_t index, std::vector<Neighbour>& found)>;
  std::size_t patch_count() const;
  void k_nearest_in_patch(std::size_t patch, std::size_t k, const PatchBody& body) const;

 private:
  std::unique_ptr<BoxTree> tree_;
};

static_assert(NeighbourSearch<BoxSearch>);

}  // namespace scan
