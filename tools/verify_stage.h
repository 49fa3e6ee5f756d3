// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Measurements against the truth, as `scan verify` and `scan run` take them.
#pragma once

#include "libscan/core/scan.h"
#include "libscan/verify/truth.h"
#include "libscan/verify/verdict.h"
#include "tools/recipe.h"

namespace scan {

// What a run measured, in the world frame where it is not the scanner's.
struct RunResult {
  std::vector<Scan> scans;            // scanner frames
  std::vector<Pose> world_from_scan;  // as aligned
  Mesh surface;
};

// Surface, topology, poses and ranges of a run. Surface figures are taken after the one rigid
// motion of the world frame that fits the poses best: an alignment cannot know where the world is.
std::vector<Measurement> measure_run(const RunResult& result, const Truth& truth,
                                     const VerifySettings& settings);

// That motion.
Pose true_world_from_world(const RunResult& result, const Truth& truth);

// The measured surface moved by it into the truth's world frame.
Mesh in_true_world(const RunResult& result, const Truth& truth);

}  // namespace scan
