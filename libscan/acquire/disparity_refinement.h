// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Disparity to a small fraction of a pixel by least squares on the images.
#pragma once

#include <cstdint>

#include "libscan/core/image.h"

namespace scan::decoding {

struct RefinedDisparity {
  Image<float> disparity_px;  // NaN where the input is
  Image<float> sigma_px;
  Image<float> correlation;  // of the two windows at the disparity
};

// Width of the window that refine() takes, px.
inline int refinement_window_px(int block_px) {
  return 2 * (block_px / 2 + 1) + 1;
}

// Newton's method on sum (L(x, y) - R(x - d(x, y), y) - c)^2 over a window about each pixel (Lucas
// and Kanade 1981), c the images' difference in brightness, R between columns by cubic convolution
// (Keys 1981). Within the window d follows the slope of the disparity map, and only pixels of the
// same surface count. The matcher's own disparity counts as a measurement of sigma
// `match_sigma_px`, which decides where there is no texture. The result stays within 1 px of it and
// moves only to lower the sum. At last what the window is off on a curved surface (window_bias.h)
// is taken away.
//
// sigma: by the errors of both that disparity weighs. Of the window: the noise of both images, of
// equal variance, which the residuals tell (never below the rounding, 1/12), through the texture's
// slopes, which hold noise too and are sampled between columns, where interpolation leaves less of
// it. Of the matcher: by how far it scatters about a plane, and its lean towards whole columns. Not
// a calibration error.
RefinedDisparity refine(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                        const Image<float>& disparity_px, int block_px, double match_sigma_px);

}  // namespace scan::decoding
