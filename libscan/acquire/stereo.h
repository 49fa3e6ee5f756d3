// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Stereo matching and Z = f B / (d + doffs).
#pragma once

#include "libscan/core/raw_frames.h"
#include "libscan/core/scan.h"

namespace scan {

struct StereoOptions {
  int block_px = 5;               // matching window (odd)
  double max_left_right_px = 1;   // left-right check
  double disparity_sigma_px = 0;  // 0: estimated per pixel from texture and residual
};

// Sub-pixel disparity of each left pixel, NaN where there is none (and why: one reason per pixel).
struct DisparityMap {
  Image<float> disparity_px;
  Image<float> sigma_px;
  std::map<std::string, std::size_t> misses;
};
DisparityMap match(const ImagePair& pair, const StereoOptions& options = {});

// Points in the left camera's frame with covariance by first-order propagation.
Scan points_from(const DisparityMap& map, const StereoCalibration& calibration);

Scan acquire_stereo(const ImagePair& pair, const StereoOptions& options = {});

}  // namespace scan
