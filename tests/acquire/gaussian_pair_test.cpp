// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/gaussian_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/acquire/readings.h"

namespace scan::decoding {
namespace {

std::vector<double> two_pulses(const Gaussian& a, const Gaussian& b) {
  std::vector<double> values;
  for (int i = 0; i < 60; ++i)
    values.push_back(a.amplitude * test::bell(i - a.centre, a.sigma) +
                     b.amplitude * test::bell(i - b.centre, b.sigma));
  return values;
}

// The model itself, so the fit ends at rounding; it stops when a step is below 1e-9 widths.
TEST(GaussianPair, IsExactForNoiseFreePairs) {
  for (const double separation : {3.0, 4.5, 8.0})
    for (const double strength : {0.3, 1.0, 5.0}) {
      const Gaussian a{20.3, 1.5, 800}, b{20.3 + separation, 1.5, 800 * strength};
      const auto values = two_pulses(a, b);
      const auto pair = fit_gaussian_pair(
          {values, 0, 2}, {{20, 1.5, 700}, {std::round(b.centre), 1.5, 700 * strength}});
      ASSERT_TRUE(pair) << separation << " " << strength;
      EXPECT_NEAR(pair->first.centre, a.centre, 1e-6);
      EXPECT_NEAR(pair->second.centre, b.centre, 1e-5);
      EXPECT_NEAR(pair->first.amplitude, a.amplitude, 1e-3);
      EXPECT_NEAR(pair->second.amplitude, b.amplitude, 1e-2);
    }
}

// Far apart they do not know of each other: the bound of one alone.
TEST(GaussianPair, HasTheBoundOfASinglePulseFarApart) {
  const Gaussian a{15, 2, 500}, b{40, 2, 2000};
  const auto values = two_pulses(a, b);
  const auto pair = fit_gaussian_pair({values, 0, 5}, {a, b});
  const auto alone = fit_gaussian({std::span(values).first(28), 0, 5}, a, Width::known);
  ASSERT_TRUE(pair && alone);
  EXPECT_NEAR(pair->first_sigma / alone->centre_sigma, 1, 1e-3);
}

// 2,000 Poisson trials at three sigma of separation, where the two places are correlated; a
// chi-square mean over trials has the standard deviation sqrt(2 / 2000).
TEST(GaussianPair, ReportsItsScatter) {
  const Gaussian a{20.2, 1.5, 800}, b{24.9, 1.5, 1500};
  const auto mean = two_pulses(a, b);
  double chi_square = 0;
  const int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    RandomStream random(5, 0, trial);
    std::vector<double> values;
    for (const double value : mean)
      values.push_back(static_cast<double>(random.poisson(value + 5)) - 5);
    const auto pair = fit_gaussian_pair({values, 0, 5}, {{20, 1.5, 700}, {25, 1.5, 1400}});
    ASSERT_TRUE(pair);
    chi_square += std::pow((pair->first.centre - a.centre) / pair->first_sigma, 2);
  }
  EXPECT_NEAR(chi_square / trials, 1, test::chi_square_margin(trials));
}

TEST(GaussianPair, IsNoneForOnePulseInTheOtherOnesPlace) {
  const auto values = two_pulses({20, 1.5, 0}, {30, 1.5, 0});
  EXPECT_FALSE(fit_gaussian_pair({values, 0, 1}, {{20, 1.5, 100}, {30, 1.5, 100}}));
}

}  // namespace
}  // namespace scan::decoding
