// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which method suits the points, and why.
#pragma once

#include <string>

#include "libscan/reconstruct/prepare_points.h"
#include "libscan/reconstruct/reconstruct.h"

namespace scan {

struct MethodChoice {
  ReconstructMethod method = ReconstructMethod::ssd;
  std::string reason;     // one sentence
  double trim_m = 0;      // surface farther from all points is to go; 0: none
  double open_share = 0;  // of the directions behind the surface: those that meet none
  double unflatness = 0;  // thickness over width of the median neighbourhood: noise, or bends
};

// A surface of which a quarter or less is missing, seen from itself, is closed: SSD, whatever the
// sampling and the holes. One with more missing is open: fitted locally where the points lie flat
// (below 0.25), which ends where the samples end; by SSD, trimmed, where they are noisy. Whether
// the scanners are known does not matter: on none of the open and closed scans that were measured
// (docs/results.md) was range fusion nearer to the truth than both.
MethodChoice choose_method(const PreparedPoints& points);

}  // namespace scan
