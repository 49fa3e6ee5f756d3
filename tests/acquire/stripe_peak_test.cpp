// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_peak.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/acquire/reason.h"
#include "tests/acquire/readings.h"

namespace scan::decoding {
namespace {

constexpr PeakMethod methods[] = {PeakMethod::centroid, PeakMethod::gaussian, PeakMethod::parabola};
const Sensor sensor{.gain_e_per_dn = 1, .offset_dn = 50};

struct Line {
  double centre, sigma, amplitude;
};

std::vector<double> row_of(std::initializer_list<Line> lines, int width, double background_e,
                           RandomStream* random = nullptr, const Sensor& with = sensor) {
  std::vector<double> row;
  for (int x = 0; x < width; ++x) {
    double expected = background_e;
    for (const Line& line : lines)
      expected += line.amplitude * test::bell(x - line.centre, line.sigma);
    row.push_back(electrons(
        with, random ? test::noisy(with, expected, *random) : test::digitise(with, expected)));
  }
  return row;
}

StripePeak locate(const std::vector<double>& row, PeakMethod method = PeakMethod::gaussian) {
  return locate_stripe(row, sensor, {.peak = method});
}

// Largest error over a sweep of sub-pixel places; amplitude 20,000 keeps the rounding of the
// readings, at most 1.8 s / A px (see below), under 1e-3 px for every width.
double worst_bias_px(PeakMethod method, double sigma) {
  double worst = 0;
  for (double centre = 99.5; centre < 100.5; centre += 1.0 / 64) {
    const StripePeak peak = locate(row_of({{centre, sigma, 20'000}}, 200, 10), method);
    EXPECT_EQ(peak.miss, "");
    worst = std::max(worst, std::abs(peak.column_px - centre));
  }
  return worst;
}

// Rounding errs by at most 1/2 in each reading m. The fit weighs by 1 / m, so the centre moves by
// at most sum |x| / 2s^2 over A sqrt(2 pi) / s, within 3 s: 4.5 s / (2.5 A) = 1.8 s / A; where few
// samples stand for the integrals (s = 0.6) by up to 3 s / A.
TEST(GaussianPeak, IsExactButForRounding) {
  for (const double sigma : {0.6, 1.0, 2.5, 5.0, 10.0})
    EXPECT_LE(worst_bias_px(PeakMethod::gaussian, sigma), 3 * sigma / 20'000) << sigma;
}

// The sampling's first alias shifts a centre of mass by 4 pi s^2 exp(-2 pi^2 s^2), 0.0037 px at 0.6
// px and nothing from 1 px on; the window's end is left.
TEST(CentroidPeak, KeepsItsStatedBias) {
  EXPECT_LE(worst_bias_px(PeakMethod::centroid, 0.6), 0.004);
  for (const double sigma : {1.0, 2.5, 5.0, 10.0})
    EXPECT_LE(worst_bias_px(PeakMethod::centroid, sigma), 0.0005) << sigma;
}

TEST(ParabolaPeak, KeepsItsStatedBias) {
  EXPECT_LE(worst_bias_px(PeakMethod::parabola, 0.6), 0.03);
  EXPECT_LE(worst_bias_px(PeakMethod::parabola, 1), 0.02);
  for (const double sigma : {2.5, 5.0, 10.0})
    EXPECT_LE(worst_bias_px(PeakMethod::parabola, sigma), 0.004) << sigma;
}

struct Statistics {
  double found = 0, spread_px2 = 0, chi_square = 0;
};

Statistics trials(PeakMethod method, double sigma, double amplitude, double background, int count) {
  Statistics result;
  for (int trial = 0; trial < count; ++trial) {
    RandomStream random(4, static_cast<std::uint32_t>(method), trial);
    const double centre = 100 + random.uniform();
    const StripePeak peak =
        locate(row_of({{centre, sigma, amplitude}}, 200, background, &random), method);
    if (!peak.miss.empty()) continue;
    const double error = peak.column_px - centre;
    ++result.found;
    result.spread_px2 += error * error;
    result.chi_square += error * error / (peak.sigma_px * peak.sigma_px);
  }
  return result;
}

// Shot noise alone: s / sqrt(N) px (physics: Cramer-Rao of a Gaussian's place). Goal 1.2; the
// ratio's own standard deviation is 1 / sqrt(2 * 1500) = 1.8 %, so it may also fall 6 % below 1.
TEST(GaussianPeak, ComesWithinATenthOfTheShotNoiseBound) {
  for (const double sigma : {0.6, 1.0, 2.5, 10.0}) {
    const double amplitude = 2000, count = 1500;
    const double bound = sigma / std::sqrt(amplitude * sigma * std::sqrt(2 * M_PI));
    const Statistics result = trials(PeakMethod::gaussian, sigma, amplitude, 0, count);
    EXPECT_EQ(result.found, count);
    const double ratio = std::sqrt(result.spread_px2 / result.found) / bound;
    EXPECT_GT(ratio, 0.94) << sigma;
    EXPECT_LT(ratio, 1.1) << sigma;
  }
}

// The background's level is itself estimated (from about 190 pixels) and widths are fitted: 5 %.
// The parabola and the centroid add their sub-pixel bias, under 5 % of the variance here.
TEST(StripePeak, ReportsItsOwnScatter) {
  const int count = 1500;
  for (const PeakMethod method : methods)
    for (const double sigma : {1.0, 2.5, 8.0}) {
      const Statistics result = trials(method, sigma, 400, 30, count);
      EXPECT_GE(result.found, 0.999 * count);
      EXPECT_NEAR(result.chi_square / result.found, 1, test::chi_square_margin(count, 0.1))
          << static_cast<int>(method) << " " << sigma;
    }
}

TEST(StripePeak, HasNoSignalInTheDark) {
  int found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    RandomStream random(5, 0, trial);
    const StripePeak peak = locate(row_of({}, 200, trial % 40, &random));
    found += peak.miss.empty();
    EXPECT_TRUE(peak.miss.empty() || peak.miss == reason::no_signal) << peak.miss;
  }
  EXPECT_EQ(found, 0);  // six sigma: 1e-9 per place, 2.4e6 places
}

TEST(StripePeak, IsAmbiguousWithTwoEqualLines) {
  for (const double distance : {6.0, 20.0, 80.0})
    EXPECT_EQ(locate(row_of({{60, 1.5, 1000}, {60 + distance, 1.5, 900}}, 200, 10)).miss,
              reason::ambiguous)
        << distance;
}

// A weaker line (a reflection, 0.3 of the height) neither hides nor moves the stripe: twelve widths
// away its light within the window is below exp(-9^2 / 2).
TEST(StripePeak, TakesTheClearlyDominantLine) {
  for (const PeakMethod method : methods) {
    const StripePeak peak = locate(row_of({{60.3, 1.5, 5000}, {78, 1.5, 1500}}, 200, 10), method);
    EXPECT_EQ(peak.miss, "");
    EXPECT_NEAR(peak.column_px, 60.3, 0.01);
  }
}

TEST(StripePeak, IsSaturatedWhenClipped) {
  const Sensor small{.offset_dn = 50, .full_well_e = 3000};
  const auto row = row_of({{60, 2, 30'000}}, 200, 10, nullptr, small);
  for (const PeakMethod method : methods)
    EXPECT_EQ(locate_stripe(row, small, {.peak = method}).miss, reason::saturated);
  const std::vector<double> white(50, 3000);
  EXPECT_EQ(locate_stripe(white, small, {}).miss, reason::saturated);
}

TEST(StripePeak, IsAtTheBorderWhenCut) {
  for (const double centre : {-1.0, 0.0, 1.0, 4.0, 196.0, 199.0, 200.0})
    EXPECT_EQ(locate(row_of({{centre, 2, 1000}}, 200, 10)).miss, reason::border) << centre;
}

// 0, 1, 2 electrons anywhere in the row, every method: no NaN.
TEST(StripePeak, StaysFiniteForFewPhotons) {
  for (const PeakMethod method : methods)
    for (int first = 0; first < 12; ++first)
      for (int second = 0; second < 12; ++second)
        for (const double more : {0.0, 1.0}) {
          std::vector<double> row(40, 0.0);
          row[10 + first] += 1;
          row[10 + second] += more;
          const StripePeak peak = locate_stripe(row, Sensor{}, {.peak = method});
          if (!peak.miss.empty()) continue;
          EXPECT_TRUE(std::isfinite(peak.column_px));
          EXPECT_TRUE(std::isfinite(peak.sigma_px) && peak.sigma_px > 0);
        }
  EXPECT_EQ(locate_stripe(std::vector<double>(40, 0.0), Sensor{}, {}).miss, reason::no_signal);
}

TEST(StripePeak, TakesARowOfOnePixel) {
  EXPECT_NE(locate_stripe(std::vector<double>{7.0}, Sensor{}, {}).miss, "");
}

}  // namespace
}  // namespace scan::decoding
