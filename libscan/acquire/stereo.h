// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Stereo matching and Z = f B / (d + doffs).
#pragma once

#include "libscan/core/raw_frames.h"
#include "libscan/core/scan.h"

namespace scan {

struct StereoOptions {
  int block_px = 5;              // matching window (odd)
  double max_left_right_px = 1;  // left-right check
  // Matches this near to a depth edge are dropped (see depth_edges.h). Windows reach block_px / 2
  // beyond the twice block_px / 2 + 1 over which the refinement takes the slope, 8 px for blocks of
  // 5: nearer to an edge they may be off by half a pixel, which sigma does not know.
  int edge_margin_px = 0;
  double disparity_sigma_px = 0;  // 0: estimated per pixel from texture and residual
};
// scan::Error (input) for a block that is even or beyond 31, and what is below its least.
void check(const StereoOptions& options);

// Semi-global matching, left-right check, then least squares on the images (see
// disparity_refinement.h). Sub-pixel disparity of each left pixel, NaN where there is none (and
// why: one reason per pixel).
struct DisparityMap {
  Image<float> disparity_px;
  Image<float> sigma_px;
  std::map<std::string, std::size_t> misses;
};

// No texture along the row: no signal; not unique, or an island of its own (a speckle): ambiguous;
// partner outside the right image, or too near to a depth edge: border; left-right check, or
// windows that do not correlate: inconsistent. A pattern that repeats within the search range
// without end is beyond these checks: one of its places is taken.
DisparityMap match(const ImagePair& pair, const StereoOptions& options = {});

// Points in the left camera's frame with rank-one covariance by first-order propagation. A
// disparity within three sigma of infinity (d + doffs = 0), or beyond: undetermined.
Scan points_from(const DisparityMap& map, const StereoCalibration& calibration);

// Neighbours share the noise of the windows that their matches were refined over.
Scan acquire_stereo(const ImagePair& pair, const StereoOptions& options = {});

}  // namespace scan
