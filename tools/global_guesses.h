// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// First guesses for scans of which nothing is known but their points.
#pragma once

#include <span>
#include <vector>

#include "libscan/align/global.h"
#include "libscan/core/progress.h"
#include "libscan/core/scan.h"

namespace scan {

struct GlobalGuess {
  Pose world_from_scan = Pose::Identity();
  // How the scan was tied to those before it; the first fixes the world. Without overlap, or with
  // too few points, it is tied to none and the pose is the identity.
  GlobalOutcome outcome = GlobalOutcome::no_overlap;
  double trust = 0;  // of that tie
};

// Every pair is aligned globally; from the first scan on, the surest tie adds the next scan, ties
// that are ambiguous last.
std::vector<GlobalGuess> global_guesses(std::span<const Scan> scans, const Progress& progress);

}  // namespace scan
