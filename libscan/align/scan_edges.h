// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pairs of many scans, each aligned by itself, and the poses that most of them agree on.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/guess_gate.h"
#include "libscan/align/pose_graph.h"
#include "libscan/align/prepared_scans.h"

namespace scan {

// A pair to align and where to start, between the clouds' own frames.
struct EdgeTask {
  std::size_t source = 0, target = 0;
  Pose target_from_source_guess = Pose::Identity();
};

// One edge per task, in their order. An interruption by the progress leaves the edges that were
// finished with options.on_edge.
std::vector<ScanEdge> align_pairs(const PreparedScans& scans, std::span<const EdgeTask> tasks,
                                  const MultiviewOptions& options, const Progress& progress);

// Solves the graph of the edges that have an answer which the guesses do not rule out, the surest
// first, and marks which of them were accepted. Poses are world_from_local, of the prepared points;
// scans that are not tied keep theirs.
struct SolvedPoses {
  std::vector<Pose> world_from_local;
  std::vector<bool> tied;
};
SolvedPoses solve_edges(const PreparedScans& scans, std::span<const Pose> starts,
                        std::vector<ScanEdge>& edges, std::size_t anchor,
                        const KnownGuesses& guesses);

// How far off the guesses put the scans, standard deviation: the median of what the pairs are off
// theirs along the motions that they fix; 0 if none fixes any.
double guess_sigma_m(const PreparedScans& scans, std::span<const ScanEdge> edges);

// How far off the solved poses may be, standard deviation: as far as the guesses, unless accepted
// pairs that leave no motion open tie together all scans that any accepted one ties; then 0, since
// these pairs have settled all.
double open_sigma_m(const PreparedScans& scans, std::span<const ScanEdge> edges);

// The information of an edge for the graph, about the target's prepared origin: that of the icp,
// less what a smooth distortion by the device may add. Of such a distortion a rigid motion absorbs
// about as much as it leaves in the residuals: sigma is their rms for the shift, and for the turn
// their rms over the size of the overlap. Along motions that the pair leaves open its pose is the
// guess's, and as sure as that: without, many pairs that each hold something else would carry
// scans farther off than the guesses had them.
PoseEdge graph_edge(const PreparedScans& scans, const ScanEdge& edge, double guess_sigma_m);

// Whether an edge is off the poses by no more than what a guess may be off, 0.05 rad and 0.05 of
// the size. Along a motion that a pair leaves open its pose is the guess's: however far it is off
// there, by its own information it would agree.
bool within_guess(const PreparedScans& scans, const ScanEdge& edge,
                  std::span<const Pose> world_from_local);

}  // namespace scan
