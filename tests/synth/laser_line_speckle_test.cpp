// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_speckle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/synth/laser_bench.h"
#include "tests/synth/speckle_covariance.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

Speckle speckle(double contrast, double grain_px) {
  return {.contrast = contrast, .grain_px = {grain_px, grain_px}};
}

// Factors of one row.
std::vector<double> factors(const Speckle& s, int step, int row, int count, int first = 0) {
  std::vector<double> row_e(count, 1.0);
  mottle(s, {.seed = 9, .scan = 2}, step, row, first, row_e);
  return row_e;
}

// Independent factors: pixels three grains apart (correlation exp(-22)) in rows of many steps.
std::vector<double> independent_factors(const Speckle& s, int count) {
  const int gap = std::max(1, static_cast<int>(std::ceil(3 * s.grain_px.x())) + 1);
  std::vector<double> all;
  for (int step = 0; static_cast<int>(all.size()) < count; ++step) {
    const std::vector<double> row = factors(s, step, 7, 40 * gap);
    for (std::size_t i = 0; i < row.size(); i += gap) all.push_back(row[i]);
  }
  return all;
}

struct Moments {
  double mean = 0;
  double variance = 0;
};

Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v / static_cast<double>(values.size());
  for (const double v : values)
    m.variance += (v - m.mean) * (v - m.mean) / static_cast<double>(values.size());
  return m;
}

// Four standard errors of the variance of n gamma variates of shape 1 / variance: excess kurtosis 6
// variance.
double variance_tolerance(double variance, double n) {
  return 4 * variance * std::sqrt((2 + 6 * variance) / n);
}

TEST(SpeckleGrain, IsThatOfTheLens) {
  LaserLine s = small_laser();
  s.wavelength_m = 650e-9;
  s.aperture_m = 1e-3;
  s.speckle_contrast = 0.5;
  EXPECT_NEAR(speckle_of(s).grain_px.x(), 650e-9 * 300 / 1e-3, 1e-15);
  EXPECT_EQ(speckle_of(s).contrast, 0.5);
  s.speckle_contrast = 0;
  EXPECT_EQ(speckle_of(s).contrast, 0);
}

// |mu|^2 of a round lens, (2 J1(v) / v)^2, and the Gaussian in its place: the same area, by the
// trapezoid rule in polar coordinates. The tail of J1^2 / v is 1 / (pi v^2) on the mean.
TEST(SpeckleGrain, HasTheAreaOfARoundLensPattern) {
  double airy = 0;
  const double step = 1e-3, end = 2000;
  for (double v = step / 2; v < end; v += step) {
    const double amplitude = 2 * std::cyl_bessel_j(1, v) / v;
    airy += amplitude * amplitude * 2 * pi * v * step;
    if (v > 60) break;
  }
  airy += 2 * pi * 4 / (pi * 60);  // the tail beyond 60
  // in units of v: the Gaussian exp(-v^2 / 4) has the area 4 pi; the tail oscillates by 1 / 60^2
  EXPECT_NEAR(airy, 4 * pi, 0.01);
}

TEST(SpecklePixel, HasGoodmansContrast) {
  for (const double grain : {0.1, 0.25, 0.7, 2.0, 8.0})
    EXPECT_NEAR(pixel_share(grain), covariance_of_pixels(grain, 0), 1e-5) << grain;
  // fine grains: the coherence length over the pixel
  EXPECT_NEAR(pixel_share(0.01), std::sqrt(pi) * 2 * 0.01 / pi, 1e-4);
  EXPECT_NEAR(pixel_share(1e4), 1, 1e-8);
}

// Both ways of making it, on either side of a quarter pixel. 2 % for the pixel's mean over a grid.
TEST(SpecklePixel, HasItsContrastInTheImage) {
  for (const double grain : {0.05, 0.2, 0.26, 0.5, 1.0, 3.0})
    for (const double contrast : {1.0, 0.85}) {
      const auto values = independent_factors(speckle(contrast, grain), 4000);
      const double n = static_cast<double>(values.size());
      const Moments found = moments(values);
      const double expected = std::pow(contrast * pixel_share(grain), 2);
      EXPECT_NEAR(found.mean, 1, 4 * std::sqrt(expected / n)) << grain << " " << contrast;
      EXPECT_NEAR(found.variance, expected, variance_tolerance(expected, n) + 0.02 * expected)
          << grain << " " << contrast;
    }
}

// Fully developed speckle: P(I > t) = exp(-t) at a point (Goodman 2007, eq. 3.17); with grains of 8
// px a pixel is one, but for a variance of 1 - pixel_share^2 = 1.3 %, which moves P by less than 1
// %.
TEST(SpecklePoint, IsExponentiallyDistributed) {
  const auto values = independent_factors(speckle(1, 8), 2000);
  const double n = static_cast<double>(values.size());
  for (const double t : {0.1, 0.5, 1.0, 2.0, 4.0}) {
    double above = 0;
    for (const double v : values) above += v > t;
    const double p = std::exp(-t);
    EXPECT_NEAR(above / n, p, 4 * std::sqrt(p * (1 - p) / n) + 0.01 * p) << t;
  }
}

// The correlation between neighbours, along the row and across rows. 4 standard errors of a mean of
// products of exponentials, whose variance is below E[(I - 1)^4] = 9.
TEST(SpecklePattern, IsCorrelatedOverAGrain) {
  const double grain = 3;
  const Speckle s = speckle(1, grain);
  for (const int lag : {1, 2, 3, 6}) {
    double along = 0, across = 0;
    int n = 0;
    for (int step = 0; step < 100; ++step) {
      const auto row = factors(s, step, 20, 300), next = factors(s, step, 20 + lag, 300);
      for (int i = 0; i + lag < 300; i += 10, ++n) {
        along += (row[i] - 1) * (row[i + lag] - 1);
        across += (row[i] - 1) * (next[i] - 1);
      }
    }
    const double expected = covariance_of_pixels(grain, lag) * covariance_of_pixels(grain, 0);
    const double tolerance = 4 * std::sqrt(9.0 / n) * std::sqrt(expected + 0.1) + 0.02 * expected;
    EXPECT_NEAR(along / n, expected, tolerance) << lag;
    EXPECT_NEAR(across / n, expected, tolerance) << lag;
  }
}

TEST(SpecklePattern, BelongsToSeedScanAndStepAndToItsPlace) {
  const Speckle coarse = speckle(0.8, 1.3);
  const auto row = factors(coarse, 3, 5, 50);
  EXPECT_EQ(row, factors(coarse, 3, 5, 50));
  EXPECT_NE(row, factors(coarse, 4, 5, 50));
  EXPECT_NE(row, factors(coarse, 3, 6, 50));
  // a part of the row is the same pattern, whatever else is lit
  const auto part = factors(coarse, 3, 5, 20, 10);
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(part[i], row[i + 10], 1e-12);
}

TEST(SpeckleImages, ObeyTheirEffectAndFollowTheStripe) {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-3;
  s.wavelength_m = 650e-9;
  s.aperture_m = 2e-4;
  s.speckle_contrast = 1;
  const RayCaster caster(white_scene({plane_at(focus_z(s))}));
  const auto image = [&](const EffectSet& effects) { return first_image(s, caster, effects); };
  const auto plain_image = image(noise_free);
  const auto mottled = image(EffectSet(noise_free).set(Effect::speckle));
  // grains of 650e-9 300 / 2e-4 = 0.975 px
  const double variance = std::pow(pixel_share(0.975), 2);
  double sum = 0, squares = 0, n = 0;
  for (int row = 1; row < 119; row += 3)
    for (int column = 77; column < 82; column += 3) {
      const double factor = mottled(column, row) / double(plain_image(column, row));
      sum += factor - 1;
      squares += (factor - 1) * (factor - 1);
      ++n;
    }
  EXPECT_NEAR(sum / n, 0, 4 * std::sqrt(variance / n));
  EXPECT_NEAR(squares / n, variance, variance_tolerance(variance, n) + 0.02 * variance);
}

}  // namespace
}  // namespace scan::synth
