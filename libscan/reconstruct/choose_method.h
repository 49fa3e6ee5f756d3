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
  double rim_extent = 0;  // of the longest chain of points without neighbours on one side, over all
  double unflatness = 0;  // thickness over width of the median neighbourhood: noise, or bends
};

// A surface with an end (a rim half as long as the whole, whatever the number of points; holes have
// short rims) is fused where the scanners are known;
// where they are not, and the points lie flat (below 0.25), it is fitted locally, which ends where
// the samples end. Everything else is a closed surface or noisy: SSD.
MethodChoice choose_method(const PreparedPoints& points);

}  // namespace scan
