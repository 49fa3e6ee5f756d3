// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The last step of many scans: correspondences of every scan against all others found anew, all
// poses moved together, until no step matters.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "libscan/align/joint_refinement.h"
#include "libscan/align/scan_edges.h"

namespace scan {

struct JointScan {
  bool paired = false;         // in a couple that counts; of others nothing below holds
  bool still = false;          // its last step was less than half of its standard error
  int iterations = 0;          // rounds in which it moved
  double rms_m = 0;            // of the weighted residuals
  double paired_fraction = 0;  // of its points asked, those with a partner in any other scan
  TwistBasis weak{6, 0};       // about the middle of its points, in units of size_m
  std::optional<Matrix6> covariance, covariance_from_guess;  // see ScanPose
};

struct JointPoses {
  std::vector<Pose> world_from_local;
  std::vector<JointScan> scans;
  std::vector<std::pair<std::size_t, std::size_t>> overlapping;  // the couples that count
  std::vector<CommonCovariance> covariances_between;
  double size_m = 1;
  int rounds = 0;
};

// From poses near the answer, which may be off by `off_m` (standard deviation) along what the pairs
// left open; scans that are not tied and the anchor stay. Weak motions come to stand as in the
// guesses. options.on_round gets world_from_local.
JointPoses refine_jointly(const PreparedScans& scans, std::span<const Pose> world_from_local,
                          std::span<const Pose> guesses, const std::vector<bool>& tied,
                          std::size_t anchor, double off_m, const MultiviewOptions& options,
                          const Progress& progress);

}  // namespace scan
