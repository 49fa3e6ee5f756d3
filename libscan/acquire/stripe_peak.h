// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The stripe's place in an image row to a fraction of a pixel.
//
// Bias for a noise-free Gaussian stripe sampled at the pixels' centres, over all sub-pixel places
// (checked by stripe_peak_test.cpp): gaussian: none but the rounding of the readings; centroid:
// below 0.004 px at sigma 0.6 px, 0.0005 px from 1 px on; parabola: below 0.03 px at sigma 0.6 px,
// 0.02 px at 1 px, 0.004 px from 2.5 px on.
#pragma once

#include "libscan/acquire/laser_line.h"
#include "libscan/acquire/stripe_search.h"

namespace scan::decoding {

struct StripePeak {
  std::string_view miss = {};
  double column_px = 0;
  double sigma_px = 0;
  double width_px = 0;  // 1 sigma of the stripe itself
  double height_e = 0;  // above the background
};

// `row_e` in electrons. A stripe whose +-3 sigma reach over the row's end is a miss (border), one
// that is no Gaussian too (inconsistent).
StripePeak locate_stripe(std::span<const double> row_e, const Sensor& sensor,
                         const LaserLineOptions& options);

}  // namespace scan::decoding
