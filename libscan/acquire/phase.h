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

// Scanner frame = camera; rank-one covariance along the pixel's ray. One frequency: distances are
// folded into [0, c / 2f), whatever max_range_m. Several: the fold that all agree on, up to
// max_range_m or to where all phases repeat. Within noise of the end of that range the fold cannot
// be told and the pixel is ambiguous, unless max_range_m ends before. Throws scan::Error (input)
// for frames that do not fit their calibration, or a range of over 10,000 wraps.
Scan acquire_phase(const PhaseTaps& frames, const PhaseOptions& options = {});

}  // namespace scan
