// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Sigma against errors: known surfaces, known noise, and starts as far off as a matcher's are.
#include "libscan/acquire/disparity_refinement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/acquire/stereo_scene.h"

namespace scan::decoding {
namespace {

constexpr int width = 240, height = 120, disparities = 64, block_px = 5, seeds = 4;
constexpr int inner_columns = 144, inner_rows = 88;  // whose windows lie within both images

// Errors of means over blocks, `scatter_px` strong, upon a lean that all share.
Image<float> starts(const test::Disparity& truth, std::uint64_t seed, double scatter_px,
                    double lean_px) {
  Image<double> white(width + block_px, height + block_px);
  for (std::size_t i = 0; i < white.pixels.size(); ++i)
    white.pixels[i] = RandomStream(seed, 7, i).normal();
  Image<float> start(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int dy = 0; dy < block_px; ++dy)
        for (int dx = 0; dx < block_px; ++dx) sum += white(x + dx, y + dy);
      start(x, y) = static_cast<float>(truth(x, y) + lean_px + scatter_px * sum / block_px);
    }
  return start;
}

struct Case {
  double slope;       // of the disparity along the row
  double noise;       // grey levels
  double scatter_px;  // of the starts
};

// Mean square of error over sigma.
double mean_square(const Case& c) {
  const test::Disparity truth = [&](double x, double y) {
    return 34 + c.slope * (x - 120) - 0.08 * (y - 60);
  };
  double sum = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const ImagePair pair =
        test::render(test::Texture(seed), truth, width, height, disparities, c.noise);
    const Image<float> start = starts(truth, seed, c.scatter_px, seed % 2 == 0 ? 0.1 : -0.1);
    const RefinedDisparity refined = refine(pair.left, pair.right, start, block_px, 1.0 / 3);
    for (int y = 16; y < 16 + inner_rows; ++y)
      for (int x = 80; x < 80 + inner_columns; ++x) {
        const double error = (refined.disparity_px(x, y) - truth(x, y)) / refined.sigma_px(x, y);
        sum += error * error;
        ++count;
      }
  }
  return sum / count;
}

// Squares of errors over a standard deviation have the mean 1, to five standard deviations of the
// mean of as many windows as fit. Central differences tell the slopes of waves of length L as
// sin(k) / k of them, k = 2 pi / L, at L = 7, the shortest here, 0.87: sigma is that much modest at
// most, its square 1 / 0.75.
TEST(DisparityRefinement, KnowsItsErrors) {
  const double windows = seeds * inner_columns * inner_rows / 49.0;
  const double chance = 5 * std::sqrt(2 / windows);
  for (const Case& c : {Case{.slope = -0.2, .noise = 1, .scatter_px = 0.3},
                        Case{.slope = 0.05, .noise = 8, .scatter_px = 0.3},
                        Case{.slope = 0.2, .noise = 1, .scatter_px = 0.1},
                        Case{.slope = 0.2, .noise = 4, .scatter_px = 0.1}}) {
    const double found = mean_square(c);
    EXPECT_LT(found, 1 + chance) << c.slope << ", " << c.noise << ", " << c.scatter_px;
    EXPECT_GT(found, 0.75 - chance) << c.slope << ", " << c.noise << ", " << c.scatter_px;
  }
}

}  // namespace
}  // namespace scan::decoding
