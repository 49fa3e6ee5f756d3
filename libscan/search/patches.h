// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The neighbours of all points of a cloud, patch by patch where the structure has patches.
#pragma once

#include "libscan/search/batch.h"

namespace scan {

// Calls body(i, found) on all threads for each of the finite points that a structure was built
// over, with its k nearest; the point itself is one.
template <NeighbourSearch S, class Body>
void k_nearest_of_own(const S& search, std::span<const Eigen::Vector3d> points, std::size_t k,
                      Body&& body) {
  if constexpr (requires { search.patch_count(); }) {
    constexpr std::size_t patches_per_task = queries_per_task / 16;
    const auto ask = [&](std::size_t patch) { search.k_nearest_in_patch(patch, k, body); };
    parallel_for(search.patch_count(), ask, patches_per_task);
  } else {
    parallel_chunks(points.size(), queries_per_task, [&](std::size_t begin, std::size_t end) {
      std::vector<Neighbour> found;
      for (std::size_t i = begin; i < end; ++i) {
        search.k_nearest(points[i], k, found);
        if (!found.empty()) body(static_cast<std::uint32_t>(i), found);
      }
    });
  }
}

}  // namespace scan
