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
};

// Gauss-Newton on sum (L(x, y) - R(x - d(x, y), y) - c)^2 over a window about each pixel (Lucas and
// Kanade 1981), c the images' difference in brightness, R between columns by cubic convolution
// (Keys 1981). Within the window d follows the slope of the disparity map, and only pixels of the
// same surface count. The result stays within 1 px of the input and is kept only if it lowers the sum.
//
// sigma: residual variance over the texture, s^2 / sum R'^2, s^2 never below the rounding of both
// images (1/6). The match itself bounds the error to about `match_sigma_px` even without texture:
// both informations are added.
RefinedDisparity refine(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right,
                        const Image<float>& disparity_px, int block_px, double match_sigma_px);

}  // namespace scan::decoding
