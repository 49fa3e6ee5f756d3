// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/local_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// The integral over waves up to `last` by the midpoint rule in t = x / (1 + x).
double integral(double last) {
  const int steps = 200000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps, x = t / (1 - t);
    if (x < last) sum += x / (1 + x * x * x) / ((1 - t) * (1 - t)) / steps;
  }
  return sum / (2 * std::numbers::pi);
}

TEST(LocalSmoothing, LeverageAndVarianceAreIntegralsOverWaves) {
  // share / (1 + share) differs from the share by its square.
  const double area = 1e-6, length = 1;
  EXPECT_NEAR(leverage(area, length) / area, integral(1e9), 1e-5);
  EXPECT_NEAR(posterior_variance(area, length) / area,
              integral(std::numbers::pi * lengths_per_cell), 1e-5);
}

TEST(LocalSmoothing, SharesAreBelowOne) {
  EXPECT_LT(leverage(1, 1e-6), 1);
  EXPECT_LT(posterior_variance(1, 1e-6), 1);
}

Samples unit_square(std::size_t side, double sigma) {
  Samples samples;
  for (std::size_t i = 0; i < side * side; ++i) {
    samples.points.emplace_back((i % side + 0.5) / side, (i / side + 0.5) / side, 0.5);
    samples.normals.push_back(Eigen::Vector3d::UnitZ());
    samples.area.push_back(1.0 / (side * side));
    samples.sigma.push_back(sigma);
  }
  return samples;
}

// Residuals that no length lowers ask for the longest one, those that fall by more than the noise a
// fit takes up for the shortest; each side of the square gets its own.
TEST(LocalSmoothing, ChoosesByRegion) {
  const Samples samples = unit_square(100, 1e-3);
  LocalSmoothing smoothing(samples);
  for (const double trial : {0.08, 0.04, 0.02}) {
    std::vector<double> residuals;
    for (const auto& u : samples.points) residuals.push_back(u[0] < 0.5 ? 1e-3 : trial);
    smoothing.judge(trial, residuals);
  }
  const std::vector<double> length = smoothing.lengths();
  for (std::size_t i = 0; i < length.size(); ++i) {
    // Regions are 0.07 wide, one lies across the middle; sums reach three of them, mixed lengths
    // one more.
    if (samples.points[i][0] < 0.5 - 0.35) {
      EXPECT_NEAR(length[i], 0.08, 1e-12);
    }
    if (samples.points[i][0] > 0.5 + 0.35) {
      EXPECT_NEAR(length[i], 0.02, 1e-12);
    }
    EXPECT_GE(length[i], 0.02 - 1e-12);
    EXPECT_LE(length[i], 0.08 + 1e-12);
  }
}

// What a region's own samples say by chance does not decide over a length that spans many regions:
// one stripe (regions are 0.07 wide) that a trial makes worse, as much as its two neighbours gain,
// keeps the old length if the trial is short and takes the new one if it is long.
TEST(LocalSmoothing, WeighsALongTrialOverItsReach) {
  const Samples samples = unit_square(100, 1e-3);
  const auto length_in_stripe = [&](double first, double second) {
    LocalSmoothing smoothing(samples);
    smoothing.judge(first, std::vector<double>(samples.points.size(), 1.0));
    std::vector<double> residuals;
    for (const auto& u : samples.points)
      residuals.push_back(u[0] > 0.4949 && u[0] < 0.5656 ? 1.6 : 0.5);
    smoothing.judge(second, residuals);
    double sum = 0, count = 0;
    const std::vector<double> lengths = smoothing.lengths();
    for (std::size_t i = 0; i < lengths.size(); ++i)
      if (samples.points[i][0] > 0.52 && samples.points[i][0] < 0.54) {
        sum += lengths[i];
        ++count;
      }
    return sum / count;
  };
  EXPECT_GT(length_in_stripe(0.02, 0.01), 0.012);
  EXPECT_NEAR(length_in_stripe(0.4, 0.2), 0.2, 1e-9);
}

TEST(LocalSmoothing, TellsHowManySamplesFaredBetter) {
  const Samples samples = unit_square(50, 1e-3);
  LocalSmoothing smoothing(samples);
  EXPECT_EQ(smoothing.judge(0.1, std::vector<double>(2500, 1e-3)), 1);
  EXPECT_EQ(smoothing.judge(0.05, std::vector<double>(2500, 1e-3)), 0);
  EXPECT_EQ(smoothing.judge(0.02, std::vector<double>(2500, 1e-6)), 1);
}

}  // namespace
}  // namespace scan
