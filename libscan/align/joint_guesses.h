// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where many scans stand along motions that the data leave open: as in the guesses.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/joint_refinement.h"

namespace scan {

struct WayToGuesses {
  std::vector<Vector6> twists;  // along the weak motions only
  bool whole = true;            // false: the way is longer than `most_m`, and this a part of it
};

// The motion along `weak` after which the scans stand where the guesses have them most likely
// (joint_prior.h). Without a prior, after which the couples stand to each other as nearly as may be
// as in the guesses, in least squares over all couples of `forms`: in a long chain the places
// drift, and a weak couple would have to make up for all of it. No couple moves by more than
// `most_m` at its size, else its partners would be lost.
WayToGuesses way_to_guesses(std::span<const JointForm> forms, const JointFrame& frame,
                            const JointBasis& weak, std::span<const Pose> world_from_local,
                            std::span<const Pose> guesses, double most_m,
                            const GuessPrior& prior = {});

}  // namespace scan
