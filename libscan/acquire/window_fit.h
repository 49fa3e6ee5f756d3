// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Two windows of a stereo pair against each other: how well they match and what noise makes of it.
#pragma once

#include <cstdint>
#include <vector>

#include "libscan/core/image.h"

namespace scan::decoding {

// What windows are compared in: (1, 2, 1) / 4 along the rows takes most of what interpolation does
// to fine texture and to noise, and with it the errors that both make (Pan 2013: Gaussian
// pre-filtering).
struct Smoothed {
  Image<float> left, right, left_slopes;
};
Image<float> in_floats(const Image<std::uint8_t>& image);
Smoothed smoothed(const Image<float>& left, const Image<float>& right);

// One pixel of the window: where it is, and its share of the disparity's slope.
struct WindowPixel {
  int column, row;
  double offset_px;  // disparity here minus disparity at the centre
};

// Sums over the window at disparity d, brightness difference eliminated.
struct Fit {
  int count = 0;
  double residual = 0;     // sum of squares
  double slopes2 = 0;      // sum of squared slopes of the right image
  double texture = 0;      // sum of left slope times right slope: free of the noise in the slopes
  double gradient = 0;     // sum of residual times slope
  double noise = 0;        // mean variance of a residual over that of a pixel
  double noise_slope = 0;  // its derivative by the disparity
};

Fit fit_at(const Smoothed& images, const std::vector<WindowPixel>& window, double d);

// Of the two windows as they are, -1 to 1; 0 if one is even.
double correlation_at(const Image<float>& left, const Image<float>& right,
                      const std::vector<WindowPixel>& window, double d);

// Sums over pairs of pixels of one row within the window, with the correlation that smoothing gives
// their noise: (6, 4, 1) / 16 of a pixel's variance at a distance of 0, 1 and 2.
struct Correlated {
  double ones = 0;     // of 1
  double texture = 0;  // of left slope times right slope, both less their means
};

Correlated correlated_at(const Smoothed& images, const std::vector<WindowPixel>& window, double d);

// Of the disparity that minimises residual / noise: 1 / variance by the images' noise, px^-2; 0
// without texture.
double information(const Fit& fit, const Correlated& noise);

}  // namespace scan::decoding
