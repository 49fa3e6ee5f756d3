// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which of many scans may see the same surface, and which pairs of them to align.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "libscan/align/prepared_cloud.h"

namespace scan {

struct Overlap {
  std::size_t source = 0, target = 0;  // source < target
  double share = 0;                    // of the points of the smaller part, near the other scan
};

// All pairs with at least `least_share`, in the order of their scans. A point counts if cubes of
// side `reach_m` put it in the other scan's or one beside it, whose mean normal is less than 60
// degrees off, from up to 512 points of each scan. The time grows with the points and with the
// pairs that overlap.
std::vector<Overlap> find_overlaps(std::span<const PreparedCloud> scans,
                                   std::span<const Pose> world_from_local, double reach_m,
                                   double least_share);

// The pairs to align, those with the largest share first: up to `most_partners` of every scan, more
// where these are other scans' choice, and what is missing to tie all that overlaps together.
std::vector<Overlap> choose_pairs(std::vector<Overlap> overlaps, std::size_t scans,
                                  std::size_t most_partners);

}  // namespace scan
