// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How fine a structure a scanner still shows: plates with waves of falling period.
//
// No standard for optical scanners fixes the limit. Here a wave is resolved if the points show at
// least half of its amplitude, as for a modulation transfer of 50 %, and if they lie densely enough
// to show it at all: nine in ten of the fields of half a period square hold a point, which a
// grid does down to 1.9 points a period (Nyquist's limit is 2). Lengths in metres.
#pragma once

#include <span>
#include <vector>

#include "libscan/verify/artefacts.h"

namespace scan {

// A square face about the origin of its own frame, of height z = amplitude cos(2 pi x / period).
struct WavePlate {
  Points points;  // as measured; only those on the face count
  double edge_m = 0;
  double period_m = 0;
  double amplitude_m = 0;
};

struct WaveResponse {
  double transfer = 0;  // fitted amplitude in phase with the true wave, over the true one
  double coverage = 0;  // share of the fields of half a period square that hold a point
};

// Least squares of height, tilts and a wave of the true period, repeated without the 0.3 % of the
// points that fit worst. Without enough points for that the transfer is 0.
WaveResponse wave_response(const WavePlate& plate);

bool is_resolved(const WaveResponse& response);

// Series of plates, each of one direction and of falling period. structural_resolution: the
// smallest period that is resolved together with all longer ones, interpolated in its logarithm
// towards the first that is not; of the series the one with the largest. Throws scan::Error:
// (input) for an empty series, (computation) where not even the longest period is resolved.
Measurement structural_resolution(std::span<const std::vector<WavePlate>> series);

}  // namespace scan
