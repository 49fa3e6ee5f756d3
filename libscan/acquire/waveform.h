// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pulse ranging: the arrival time of an echo in a digitised waveform.
#pragma once

#include "libscan/core/raw_frames.h"
#include "libscan/core/scan.h"

namespace scan {

enum class PulseMethod { leading_edge, centroid, matched_filter };

struct WaveformOptions {
  PulseMethod pulse = PulseMethod::matched_filter;
  double threshold_sigmas = 6;  // of the noise before the echo
};

// The first echo above the threshold of each ray; rank-one covariance along it. The background
// comes from the ray's own samples and is right while echoes fill less than half of them. An echo
// within two pulse_sigma_s of the record's ends: border. Two echoes are told apart once a valley
// deeper than the noise parts them in the correlation with the pulse: strong equal ones at some 3.5
// pulse_sigma_s; closer ones are one point between them. Light that the record begins with and that
// only falls, as from near fog, is no echo: the next one counts. Throws scan::Error (input) for
// frames that do not fit their calibration.
Scan acquire_waveform(const Waveforms& frames, const WaveformOptions& options = {});

}  // namespace scan
