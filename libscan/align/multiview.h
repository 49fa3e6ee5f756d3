// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many scans into one frame: pair by pair along their order, then all at once.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/icp.h"
#include "libscan/core/progress.h"
#include "libscan/core/scan.h"

namespace scan {

struct MultiviewOptions {
  IcpOptions icp = {};
  double thin_m = 0;         // voxel side for the joint step; 0: from the data
  int max_rounds = 20;       // correspondences found anew, then one Ceres solve
  double min_overlap = 0.1;  // pairs below this inlier fraction do not count
  int anchor = 0;            // the scan whose pose is kept
};

// Throws scan::Error (usage) naming the option and its limit.
void check(const MultiviewOptions& options);

struct ScanPose {
  Pose world_from_scan = Pose::Identity();
  Stop stop = Stop::too_few_points;
  int iterations = 0;
  double rms_m = 0;
  double inlier_fraction_of_source = 0;
  double agreement = 0;  // share of its points near other scans that lie on them within noise
  std::vector<std::string> weak_directions;
};

struct MultiviewResult {
  std::vector<ScanPose> scans;  // in the order of the input
  std::size_t pairs_used = 0;   // pairs of scans in the joint problem
  int rounds = 0;
  Stop stop = Stop::too_few_points;
  Cost cost;
};

// `clouds` in their scanner frames with normals; guesses world_from_scan. First each scan is added
// to those already placed, nearest by predicted overlap first; then all poses but the anchor's are
// refined together by Ceres over point-to-plane pairs between all overlapping scans.
MultiviewResult align_scans(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
                            const MultiviewOptions& options = {}, const Progress& progress = {});

}  // namespace scan
