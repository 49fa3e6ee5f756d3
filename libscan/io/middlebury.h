// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The calibration file of Middlebury's stereo sets (Scharstein et al., GCPR 2014).
#pragma once

#include <filesystem>

#include "libscan/core/raw_frames.h"

namespace scan {

// Lines KEY=VALUE: cam0 and cam1 as [f 0 cx; 0 f cy; 0 0 1], doffs, baseline (mm), width, height,
// ndisp; others are left out. scan::Error (input) names file and key.
StereoCalibration read_middlebury_calibration(const std::filesystem::path& path);

}  // namespace scan
