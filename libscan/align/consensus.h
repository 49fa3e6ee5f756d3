// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Motions that many of the correspondences agree on, when nearly all of them may be wrong.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libscan/align/compatibility.h"
#include "libscan/core/pose.h"

namespace scan {

struct ConsensusOptions {
  double noise_m = 0;           // right correspondences lie within it of each other once moved
  double least_distance_m = 0;  // correspondences nearer to each other do not support each other
  double cosine = 2;            // see CompatibilityLimits
  std::size_t most_poses = 64;
  double most_by_chance = 1e-3;  // poses of which chance would offer more are left out
};

struct ConsensusPose {
  Pose target_from_source = Pose::Identity();
  std::vector<std::uint32_t> inliers;  // rising
  // Expected number of poses that so many of as many unrelated correspondences would agree on.
  double expected_by_chance = 0;
};

struct Consensus {
  std::vector<ConsensusPose> poses;  // different ones, most inliers first; none: not certain
  // No motion is supported by more correspondences that pairwise agree: proved.
  std::size_t clique_bound = 0;
  std::size_t largest_clique = 0;
};

// Cliques of the compatibility graph around each correspondence that is in none yet, the largest
// one by branch and bound within a budget; each clique gives a pose by least squares, which gathers
// its inliers anew.
Consensus find_consensus(std::span<const Correspondence> correspondences,
                         const ConsensusOptions& options);

}  // namespace scan
