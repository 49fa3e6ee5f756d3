// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many scans into one frame: pairs that overlap, a graph of them that drops the wrong ones, then
// all poses at once.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "libscan/align/icp.h"
#include "libscan/core/progress.h"
#include "libscan/core/scan.h"
#include "libscan/core/stated_poses.h"

namespace scan {

// A pair of scans that was aligned by itself.
struct ScanEdge {
  std::size_t source = 0, target = 0;
  Pose target_from_source_guess = Pose::Identity();
  Pose target_from_source = Pose::Identity();
  Stop stop = Stop::too_few_points;
  double overlap = 0;    // share of the source's points with a partner
  double agreement = 0;  // share of its points near the target that lie on it within noise
  double rms_m = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the overlap, target frame
  // Inverse covariance of the pose as a twist about the centre (rad, m), see IcpResult.
  Matrix6 information = Matrix6::Zero();
  bool accepted = false;        // agrees with the poses that came of all pairs
  std::vector<Pose> path = {};  // target_from_source at its start and after each iteration
};

struct MultiviewOptions {
  IcpOptions icp = {};  // icp.search and icp.min_overlap hold for all steps
  double thin_m = 0;    // voxel side; 0: from the data
  int max_rounds = 60;  // of the joint step: correspondences found anew, then one solve
  int anchor = 0;       // the scan whose pose is kept
  // How far off each scan's guess is, the one's error telling nothing of another's; empty: nobody
  // knows. The anchor's makes all others as much worse; a scan and the anchor must not both be
  // exact.
  std::vector<GuessSigma> guess_sigmas = {};
  // Pairs of an earlier, interrupted call: not aligned again when their guess is wanted once more.
  std::vector<ScanEdge> known_edges = {};
  // Called for each pair that is aligned, in any order; never from two threads at once.
  std::function<void(const ScanEdge&)> on_edge = {};
  // Called with the poses that the joint step begins with and with those after each of its rounds.
  std::function<void(std::span<const Pose> world_from_scan)> on_round = {};
};

// Throws scan::Error (usage) naming the option and its limit.
void check(const MultiviewOptions& options);

struct ScanPose {
  Pose world_from_scan = Pose::Identity();
  Stop stop = Stop::too_few_points;
  int iterations = 0;  // of the joint step in which it moved
  double rms_m = 0;
  double inlier_fraction_of_source = 0;
  double agreement = 0;  // share of its points near other scans that lie on them within noise
  std::vector<std::string> weak_directions;
  // Of a turn (rad) about the middle of the scan's points and a shift (m) of that middle, along the
  // world's axes, the anchor held; none if the scan is not aligned, or a motion is weak and nobody
  // knows how far off the guess is. Noise, also such as neighbours share, counts; a smooth
  // distortion by the device does not.
  std::optional<Matrix6> covariance;
  // The part of it that no data tell: along the weak motions the scan stands as in its guess.
  std::optional<Matrix6> covariance_from_guess;
  Eigen::Vector3d covariance_centre = Eigen::Vector3d::Zero();  // that middle, world
};

struct MultiviewResult {
  std::vector<ScanPose> scans;                        // in the order of the input
  std::vector<ScanEdge> edges;                        // by source, then target
  std::vector<CommonCovariance> covariances_between;  // of scans that see the same
  std::size_t pairs_used = 0;                         // pairs of scans in the joint step
  int rounds = 0;
  Stop stop = Stop::too_few_points;
  Cost cost;
};

// `clouds` in their scanner frames with normals; guesses world_from_scan. Pairs that the guesses
// let overlap are aligned by icp; solve_pose_graph tells which of them agree; pairs that did not
// are tried again from its poses; at last all poses but the anchor's are refined together over
// correspondences between all overlapping scans. Scans that no accepted edge ties to the anchor
// keep their guess and stop as no_correspondences. With `guess_sigmas` pairs that the guesses rule
// out (guess_gate.h) do not count, and the guesses do as measurements in the last step, so that
// what the data leave open stands as they have it most likely; without, the scans stand to each
// other as nearly as in the guesses.
MultiviewResult align_scans(std::span<const PointCloud> clouds, std::span<const Pose> guesses,
                            const MultiviewOptions& options = {}, const Progress& progress = {});

}  // namespace scan
