// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Phase cameras: taps to phase, phase to distance over one or more frequencies.
#pragma once

#include "libscan/core/raw_frames.h"
#include "libscan/core/scan.h"

namespace scan {

struct PhaseOptions {
  double min_amplitude_sigmas = 5;      // amplitude over its own standard deviation
  double max_inconsistency_sigmas = 4;  // of the frequencies' distances after unwrapping
};

Scan acquire_phase(const PhaseTaps& frames, const PhaseOptions& options = {});

}  // namespace scan
