// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which relative poses to trust first: those that close loops of three scans.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/pose_graph.h"

namespace scan {

// Per edge: loops of three scans through it that close within the 99.9 % quantile of what their
// edges' covariances allow (Zach, Klopschitz, Pollefeys 2010).
std::vector<int> closed_loops(std::span<const PoseEdge> edges, std::size_t scans);

struct SpanningTree {
  std::vector<Pose> world_from_scan;
  std::vector<bool> reached;
  std::size_t depth = 0;  // edges from the anchor to the farthest scan
};

// Scans that edges of closed loops tie are joined first (Kruskal: most loops first, edges of equal
// count in their order); then clusters of them, each time by the edge between two clusters that
// most others between these two confirm. What the anchor's tree does not reach keeps its start.
SpanningTree spanning_tree(std::span<const Pose> starts, std::span<const PoseEdge> edges,
                           std::size_t anchor);

}  // namespace scan
