// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rectified pairs by formula: a smooth random texture on a surface given by its disparity.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "libscan/core/random.h"
#include "libscan/core/raw_frames.h"

namespace scan::test {

// Sum of plane waves of at least 7 px: the cubic convolution of the refinement then errs by under
// 0.5 % of a wave's amplitude.
class Texture {
 public:
  explicit Texture(std::uint64_t seed) {
    RandomStream random(seed, 0, 0);
    for (int i = 0; i < 60; ++i) {
      const double direction = 2 * M_PI * random.uniform();
      const double wavelength_px = 7 + 30 * random.uniform();
      waves_.push_back({2 * M_PI * std::cos(direction) / wavelength_px,
                        2 * M_PI * std::sin(direction) / wavelength_px,
                        2 * M_PI * random.uniform()});
    }
  }
  // Grey levels, mean 128, standard deviation 30.
  double operator()(double x, double y) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::cos(wave.kx * x + wave.ky * y + wave.phase);
    return 128 + 30 * sum / std::sqrt(waves_.size() / 2.0);
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves_;
};

using Disparity = std::function<double(double x, double y)>;  // of the left image, |d d / dx| < 1

// The right pixel x' sees the left place x with x - d(x, y) = x'.
inline double left_place(const Disparity& disparity, double right_x, double y, double max_px) {
  double low = right_x, high = right_x + max_px;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (middle - disparity(middle, y) < right_x ? low : high) = middle;
  }
  return low;
}

inline std::uint8_t grey(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0, 255.0));
}

// Normal noise of `noise` grey levels in both images (0: rounding alone).
inline ImagePair render(const Texture& texture, const Disparity& disparity, int width, int height,
                        int disparities, double noise) {
  ImagePair pair;
  pair.calibration = {.width_px = width,
                      .height_px = height,
                      .focal_px = 500,
                      .cx_px = (width - 1) / 2.0,
                      .cy_px = (height - 1) / 2.0,
                      .doffs_px = 5,
                      .baseline_m = 0.1,
                      .min_disparity_px = 0,
                      .disparities_px = disparities};
  pair.left = pair.right = Image<std::uint8_t>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      RandomStream random(41, 0, pair.left.index(x, y));
      pair.left(x, y) = grey(texture(x, y) + noise * random.normal());
      pair.right(x, y) =
          grey(texture(left_place(disparity, x, y, disparities), y) + noise * random.normal());
    }
  return pair;
}

}  // namespace scan::test
