// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/gaussian_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/acquire/readings.h"

namespace scan::decoding {
namespace {

std::vector<double> pulse(double centre, double sigma, double amplitude, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(amplitude * test::bell(i - centre, sigma));
  return values;
}

// The model itself, so the fit ends at rounding; it stops when a step is below 1e-9 widths.
TEST(GaussianFit, IsExactForNoiseFreeGaussians) {
  for (const double sigma : {0.6, 1.0, 3.0, 10.0})
    for (double centre = 39.5; centre < 40.5; centre += 0.0625) {
      const auto values = pulse(centre, sigma, 1000, 81);
      const auto fit =
          fit_gaussian({values, 0, 1}, {std::round(centre), 1.3 * sigma, 700}, Width::free);
      ASSERT_TRUE(fit) << sigma << " " << centre;
      EXPECT_NEAR(fit->shape.centre, centre, 1e-6 * sigma);
      EXPECT_NEAR(fit->shape.sigma, sigma, 1e-5 * sigma);
      EXPECT_NEAR(fit->shape.amplitude, 1000, 1e-2);
    }
}

// Golden value of the reference: sigma / sqrt(N). Background variance 1e-9 leaves shot noise alone;
// the sum over samples equals the integral to 1e-3 for sigma >= 1.
TEST(GaussianFit, ReportsTheShotNoiseBound) {
  const double sigma = 2, amplitude = 500, electrons = amplitude * sigma * std::sqrt(2 * M_PI);
  const auto values = pulse(30.2, sigma, amplitude, 61);
  const auto fit = fit_gaussian({values, 0, 1e-9}, {30, 2, 500}, Width::known);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->centre_sigma, sigma / std::sqrt(electrons), 1e-3 * fit->centre_sigma);
}

// Without shot noise (variance v per sample): sigma^2 = v / sum m'^2, sum m'^2 = A^2 sqrt(pi) / 2s.
TEST(GaussianFit, ReportsTheReadNoiseBound) {
  const double sigma = 3, amplitude = 10, variance = 1e4;  // variance >> amplitude
  const auto values = pulse(30, sigma, amplitude, 61);
  const auto fit = fit_gaussian({values, 0, variance}, {30, 3, 10}, Width::known);
  ASSERT_TRUE(fit);
  const double information = amplitude * amplitude * std::sqrt(M_PI) / (2 * sigma);
  EXPECT_NEAR(fit->centre_sigma, std::sqrt(variance / information), 1e-3 * fit->centre_sigma);
}

// 2,000 Poisson trials. The ratio of the empirical spread to the bound has a standard deviation of
// 1 / sqrt(2 * 2000) = 1.6 %; an efficient estimate lies within four of these of 1.
TEST(GaussianFit, AttainsTheBoundUnderShotNoise) {
  const double sigma = 1.5, amplitude = 200, background = 20;
  double chi_square = 0;
  const int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    RandomStream random(3, 0, trial);
    const double centre = 15 + random.uniform();
    auto values = pulse(centre, sigma, amplitude, 31);
    for (double& value : values)
      value = static_cast<double>(random.poisson(value + background)) - background;
    const auto fit = fit_gaussian({values, 0, background}, {15.5, 1.5, 200}, Width::free);
    ASSERT_TRUE(fit);
    const double error = (fit->shape.centre - centre) / fit->centre_sigma;
    chi_square += error * error;
  }
  EXPECT_NEAR(chi_square / trials, 1, test::chi_square_margin(trials));
}

TEST(GaussianFit, RefusesWhatHasNoPeak) {
  const std::vector<double> falling{9, 8, 7, 6, 5, 4, 3, 2, 1, 0};
  const std::vector<double> dark(10, 0.0);
  EXPECT_FALSE(fit_gaussian({dark, 0, 1}, {5, 1, 0}, Width::free));
  const auto fit = fit_gaussian({falling, 0, 1}, {5, 1, 5}, Width::known);
  EXPECT_TRUE(!fit || std::isfinite(fit->centre_sigma));
}

// 0, 1, 2 electrons in all: a finite answer or none.
TEST(GaussianFit, NeverGivesANanForFewPhotons) {
  for (int first = 0; first < 9; ++first)
    for (int second = -1; second < 9; ++second) {
      std::vector<double> values(9, 0.0);
      values[first] += 1;
      if (second >= 0) values[second] += 1;
      for (const Width width : {Width::known, Width::free}) {
        const auto fit = fit_gaussian({values, 0, 1e-6}, {first + 0.0, 1, 1}, width);
        if (!fit) continue;
        EXPECT_TRUE(std::isfinite(fit->shape.centre) && fit->centre_sigma > 0 &&
                    std::isfinite(fit->centre_sigma));
      }
    }
}

// The window is symmetric about the result, so only the sampling is left: its first alias shifts
// the centre by 2 s^2 2 pi exp(-2 pi^2 s^2), 0.0037 px at 0.6 px, nothing from 1 px on; the
// truncation at 3 s + 1 px, where the end samples count by their covered share, leaves less than
// 1e-3 s.
TEST(Centroid, IsCentredOnItsOwnWindow) {
  for (const double sigma : {0.6, 1.0, 3.0, 10.0})
    for (double centre = 39.5; centre < 40.5; centre += 0.0625) {
      const auto values = pulse(centre, sigma, 1000, 81);
      const auto found = centroid({values, 0, 1}, {40, sigma, 1000});
      ASSERT_TRUE(found);
      const double alias = 4 * M_PI * sigma * sigma * std::exp(-2 * M_PI * M_PI * sigma * sigma);
      EXPECT_NEAR(found->shape.centre, centre, 1e-3 * sigma + alias) << sigma << " " << centre;
    }
}

TEST(Centroid, RefusesDarkness) {
  const std::vector<double> dark(20, -1.0);
  EXPECT_FALSE(centroid({dark, 0, 1}, {10, 2, 1}));
}

}  // namespace
}  // namespace scan::decoding
