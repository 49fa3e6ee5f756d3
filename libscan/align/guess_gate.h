// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which pairs the guesses rule out by what is stated of their errors.
#pragma once

#include <span>

#include "libscan/align/pose_graph.h"
#include "libscan/align/prepared_scans.h"

namespace scan {

struct KnownGuesses {
  std::span<const Pose> world_from_local;  // of the prepared points
  std::span<const GuessSigma> sigmas;      // empty: nobody knows, and no pair is ruled out
};

// On bodies that nearly fit themselves elsewhere pairs agree with each other on poses far from all
// guesses. True if the pair's pose is off that of its scans' guesses by more than the errors of
// both and its own explain: e^T (E + I^-1)^-1 e, e the twist between them, E the covariance of the
// guesses' errors, I the pair's information, which counts along what it fixes alone.
bool is_ruled_out(const PreparedScans& scans, const PoseEdge& edge, const KnownGuesses& guesses);

}  // namespace scan
