// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The first step of many scans: each is added to those already placed, the surest first.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/multiview.h"

namespace scan {

// How near to another scan a point of this one counts as seen by both: as far as a guess may be
// off.
double overlap_reach_m(const PointCloud& cloud);

// Share of the points of `a` that have a point of `b` within `distance_m` whose normal is less than
// 60 degrees off, from up to 512 of them. Zero if either is empty.
double predicted_overlap(const PointCloud& a, const Pose& world_from_a, const PointCloud& b,
                         const KdTree& b_search, const Pose& world_from_b, double distance_m);

// Starts from `scans[i].world_from_scan` as guesses. Repeatedly takes the scan that overlaps most
// with what is placed and aligns it with that by icp. A scan that reaches less than
// options.min_overlap keeps its guess with the stop no_correspondences. `placed[anchor]` must be
// true.
void place_in_turn(std::span<const PointCloud> clouds, std::span<const KdTree> searches,
                   const MultiviewOptions& options, const Progress& progress,
                   std::vector<ScanPose>& scans, std::vector<bool>& placed);

}  // namespace scan
