// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Noise in the images: it must not draw disparities, and their sigma must say what it does.
#include "libscan/acquire/disparity_refinement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/acquire/stereo_scene.h"

namespace scan::decoding {
namespace {

constexpr int block_px = 5, window_px = 7;

constexpr int width = 260, height = 200, seeds = 4;

// Of a plane that faces the pair, so that a place of the left image is simply `disparity_px` away.
ImagePair noisy_pair(std::uint64_t seed, double disparity_px, double noise) {
  const test::Texture texture(seed);
  ImagePair pair{.calibration = {},
                 .left = Image<std::uint8_t>(width, height),
                 .right = Image<std::uint8_t>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      RandomStream random(seed, 0, pair.left.index(x, y));
      pair.left(x, y) = test::grey(texture(x, y) + noise * random.normal());
      pair.right(x, y) = test::grey(texture(x + disparity_px, y) + noise * random.normal());
    }
  return pair;
}

// Errors over sigma at places whose windows share no pixel, of matches that start 0.1 px off and
// know nothing else.
struct Normalised {
  double mean = 0, mean_square = 0, count = 0;
};

Normalised errors_at(double disparity_px, double noise) {
  Normalised sum;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const ImagePair pair = noisy_pair(seed, disparity_px, noise);
    const Image<float> start(width, height, static_cast<float>(disparity_px + 0.1));
    const RefinedDisparity refined = refine(pair.left, pair.right, start, block_px, 1e3);
    for (int row = window_px; row < height - window_px; row += window_px)
      for (int column = 40; column < width - window_px; column += window_px) {
        const double error =
            (refined.disparity_px(column, row) - disparity_px) / refined.sigma_px(column, row);
        sum.mean += error;
        sum.mean_square += error * error;
        ++sum.count;
      }
  }
  sum.mean /= sum.count;
  sum.mean_square /= sum.count;
  return sum;
}

// Squares of errors over a standard deviation have the mean 1, to five standard deviations of the
// mean of `count`, on columns and between. What the sum of squared residuals alone would make of
// it: of a pixel's noise n = 5 interpolation leaves w = 1 - u^2 (4.5 + 5 u), u = t (1 - t), in
// windows of 49 px 49 n^2 w, against the texture's own curvature 2 G, G = 49 * 900 / 2 * (2 pi)^2 /
// (7 * 37) = 3400: more than all of it on a column, and a quarter is drawn by 0.2 px, 1.6 sigma.
// Smoothed images leave a ninth of that, a tenth of the curvature on a column and half-way. Cubic
// convolution errs by 0.5 % of a wave of 7 px, 0.006 px of a sigma of 0.12 px.
TEST(DisparityRefinement, NoiseIsInSigmaAndNotInTheDisparity) {
  for (const double disparity_px : {20.0, 20.25, 20.5}) {
    const Normalised errors = errors_at(disparity_px, 5);
    EXPECT_EQ(errors.count, seeds * 27 * 31);
    EXPECT_NEAR(errors.mean, 0, 5 / std::sqrt(errors.count) + 0.05) << disparity_px;
    EXPECT_NEAR(errors.mean_square, 1, 5 * std::sqrt(2 / errors.count)) << disparity_px;
  }
}

}  // namespace
}  // namespace scan::decoding
