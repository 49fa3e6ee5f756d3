// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The pixels about one that lie on its surface, and how sure the matcher's disparities are there.
#pragma once

#include <vector>

#include "libscan/core/image.h"

namespace scan::decoding {

// One pixel of the window: where it is, and its share of the disparity's slope.
struct WindowPixel {
  int column, row;
  int dx, dy;        // from the centre
  double offset_px;  // disparity here minus disparity at the centre
};

// What the matcher's disparities are off by, variances.
struct MatcherErrors {
  double disparity_px2 = 0;  // at the centre
  double slope = 0;          // of each of the plane's two slopes
};

struct Window {
  std::vector<WindowPixel> pixels;
  double row_slope = 0;  // of the disparity along the row
  MatcherErrors matcher;
};

// By the matcher's disparities, NaN where there are none; there must be one at the centre.
Window window_at(const Image<float>& disparity_px, int column, int row, int block_px);

}  // namespace scan::decoding
