// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Measurements against the truth, as `scan verify` and `scan run` take them.
#pragma once

#include <optional>

#include "libscan/core/scan.h"
#include "libscan/io/surface_file.h"
#include "libscan/verify/pose_error.h"
#include "libscan/verify/stated_uncertainty.h"
#include "libscan/verify/truth.h"
#include "libscan/verify/verdict.h"
#include "tools/recipe.h"

namespace scan {

// What a run measured, in the world frame where it is not the scanner's.
struct RunResult {
  std::vector<Scan> scans;            // scanner frames
  std::vector<Pose> world_from_scan;  // as aligned
  SupportedMesh surface;
  StatedPoses stated_poses = {};
  std::size_t anchor = 0;  // the scan that they are relative to
};

void add(std::vector<Measurement>& to, std::vector<Measurement> more);

// Sizes, topology, self-intersections and, where the vertices know them, unsupported area and the
// honesty of the standard errors. These hold the scan right that poses are relative to: for them
// the surface is moved by `by_anchor`.
std::vector<Measurement> measure_shape(const SupportedMesh& surface, const TrueSurface& truth,
                                       const Pose& by_anchor = Pose::Identity());

// The corners of a box: where target registration errors are felt.
std::vector<Eigen::Vector3d> corners_of(const Bounds& box);

// Surface, shape, poses and ranges of a run. Surface figures are taken after the one rigid motion
// of the world frame that fits the poses best: an alignment cannot know where the world is. Targets
// are the corners of the true surface's box, or of the measured one's where that has no end. Throws
// scan::Error (input) if the truth knows another number of scans.
std::vector<Measurement> measure_run(const RunResult& result, const Truth& truth,
                                     const VerifySettings& settings);

// Of each scan, felt at some of its points; the world frame is fitted as above.
std::vector<PoseError> run_pose_errors(const RunResult& result, const Truth& truth);

// That motion.
Pose true_world_from_world(const RunResult& result, const Truth& truth);

// The measured surface moved by it into the truth's world frame.
Mesh in_true_world(const RunResult& result, const Truth& truth);

}  // namespace scan
