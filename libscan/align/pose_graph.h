// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Poses of many scans from measured relative poses of some pairs, a part of which may be wrong.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "libscan/core/pose.h"

namespace scan {

// The pose of `source` in the frame of `target` as measured. `information` is that of a left twist
// (rotation rad, translation m) in the target's frame, about its origin, which should lie near its
// points; it may be singular where the pair leaves a motion open.
struct PoseEdge {
  std::size_t source = 0, target = 0;
  Pose target_from_source = Pose::Identity();
  Matrix6 information = Matrix6::Identity();
};

struct PoseGraph {
  std::vector<Pose> world_from_scan;
  std::vector<bool> tied;      // per scan: to the anchor by accepted edges; others keep their start
  std::vector<bool> accepted;  // per edge
  std::vector<double> chi_square;  // per edge: squared error at the end, by its information
  // Of the rotation about the scan's origin (rad) and of that origin (m), along the world's axes,
  // the anchor held; none where the accepted edges leave a motion open, and for scans not tied.
  std::vector<std::optional<Matrix6>> covariance;
};

// Least squares over the edges that agree, by Ceres: a spanning tree of edges that others confirm
// gives the start, from which graduated non-convexity with truncated squares (Yang, Antonante,
// Tzoumas, Carlone 2020) narrows the limit to the 99.9 % quantile of chi-square. Edges stand in the
// order of trust: of two that are equally confirmed the earlier one counts.
// Throws scan::Error (input) for edges that name no scan or are not finite.
PoseGraph solve_pose_graph(std::span<const Pose> starts, std::span<const PoseEdge> edges,
                           std::size_t anchor);

// 99.9 % quantile of chi-square with as many degrees of freedom as `information` has motions that
// it fixes; 0 if it fixes none.
double chi_square_limit(const Matrix6& information);

}  // namespace scan
