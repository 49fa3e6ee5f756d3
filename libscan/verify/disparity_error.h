// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far a disparity image is from a published one.
#pragma once

#include "libscan/core/image.h"
#include "libscan/verify/verdict.h"

namespace scan {

// disparity_bad_2px: share of the pixels with known truth that were matched
// and are off by more than 2 px; disparity_bad_2px_all: the same over all pixels with known truth,
// unmatched ones counted as bad; disparity_density: share of the pixels with known truth that were
// matched; disparity_error_median (px); relative_depth_error_median: |Z - Z*| / Z* with
// Z ~ 1 / (d + doffs_px). NaN (or infinity) is unknown. Throws scan::Error (input) for images of
// different size or without a known true pixel; figures over no matched pixel are NaN.
std::vector<Measurement> disparity_error(const Image<float>& measured, const Image<float>& truth,
                                         double doffs_px);

}  // namespace scan
