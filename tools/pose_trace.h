// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The way of the poses from the guesses to the answer, for people to look at.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "libscan/align/multiview.h"

namespace scan {

struct PoseStep {
  std::string step;  // "guess", "pairs 3", "joint 2"
  std::vector<Pose> world_from_scan;
};

// The guesses, then the poses after each iteration of the pairs, chained from the anchor along a
// tree of the accepted edges (breadth first, in their order; a pair that has come to rest stays),
// then `joint`: what MultiviewOptions::on_round was given. Of more steps than `most_steps` an even
// choice that keeps the first and the last of the pairs and of the joint step.
std::vector<PoseStep> pose_steps(std::span<const Pose> guesses, std::span<const ScanEdge> edges,
                                 const std::vector<std::vector<Pose>>& joint, std::size_t anchor,
                                 std::size_t most_steps);

// pose_trace.json: `steps`: [{`step`, `world_from_scan`: [[x, y, z, qx, qy, qz, qw] of each
// scan]}].
nlohmann::ordered_json trace_json(std::span<const PoseStep> steps);
std::vector<PoseStep> steps_from(const nlohmann::ordered_json& trace);

}  // namespace scan
