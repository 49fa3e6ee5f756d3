// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Correspondences between all scans that overlap, at given poses.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "libscan/align/joint_refinement.h"
#include "libscan/align/prepared_cloud.h"

namespace scan {

// A scan thinned to its finite points, in its own frame, with what is built over it once.
struct PreparedScan {
  explicit PreparedScan(PointCloud thinned);
  PointCloud cloud;
  KdTree search;
  std::vector<LocalFit> fits;
  double spacing_m = 0;
};

using ScanCouple = std::pair<std::size_t, std::size_t>;

struct JointGates {
  double distance_m = 0;
  double least_cosine = 0;   // between paired normals
  double tukey_limit_m = 0;  // 0: not yet known
  double min_overlap = 0;    // share of the smaller scan's points
};

struct JointPairs {
  std::vector<ScanCouple> couples;  // worth trying in the next round: at least half of min_overlap
  std::vector<ScanPairForm> forms;
  double tukey_limit_m = 0;             // for the next round, never larger than the one before
  std::vector<double> paired_fraction;  // per scan, of its points with a partner in any other
  std::vector<double> rms_m;            // per scan, of the weighted residuals
};

// Pairs between the scans of each couple, in the frame of `poses`; forms about `frame`. Motions
// that a couple does not fix are taken out of its forms.
JointPairs pair_scans(const std::vector<std::unique_ptr<PreparedScan>>& scans,
                      const std::vector<Pose>& poses, const std::vector<ScanCouple>& couples,
                      const DataFrame& frame, const JointGates& gates);

}  // namespace scan
