// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The Point Cloud Library's alignment without a guess, for comparison.
#pragma once

#include <optional>

#include "libscan/align/features.h"
#include "libscan/core/pose.h"

namespace scan {

// FPFH at five sides and SampleConsensusPrerejective (Buch et al. 2013) with the settings of its
// tutorial, on the same thinned points and normals; empty if it does not converge.
std::optional<Pose> pcl_prerejective(const ScanFeatures& source, const ScanFeatures& target);

}  // namespace scan
