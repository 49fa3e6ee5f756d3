// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace scan::synth {
namespace {

constexpr DetectorEffects no_effects{false, false, true};

struct Statistics {
  double mean = 0;
  double variance = 0;
};

Statistics statistics(const Sensor& sensor, const DetectorEffects& effects, double expected_e,
                      int count) {
  RandomStream random(1, 2, 3);
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double dn = read_pixel(sensor, effects, expected_e, random);
    sum += dn;
    squares += dn * dn;
  }
  const double mean = sum / count;
  return {mean, squares / count - mean * mean};
}

// EMVA 1288, eq. 10 f.: mean = K mu_e + offset, variance = K^2 (sigma_d^2 + mu_e) + 1/12 DN^2.
TEST(Detector, HasTheMeanAndVarianceOfEmva1288) {
  const Sensor sensor{
      .gain_e_per_dn = 4, .offset_dn = 64, .read_noise_e = 12, .full_well_e = 1e6, .bits = 16};
  const int count = 400000;
  for (const double mean_e : {0.0, 1.0, 2.0, 20.0, 1000.0, 100000.0}) {
    const double variance = (mean_e + 144) / 16 + 1.0 / 12;
    const Statistics found = statistics(sensor, {}, mean_e, count);
    // four standard errors of mean and variance
    EXPECT_NEAR(found.mean, mean_e / 4 + 64, 4 * std::sqrt(variance / count)) << mean_e;
    EXPECT_NEAR(found.variance, variance, 4 * variance * std::sqrt(2.0 / count)) << mean_e;
  }
}

// R11: counts of few electrons are Poisson's; chi-square of the first bins.
TEST(Detector, CountsFewElectronsAsPoissonDoes) {
  const Sensor sensor{.gain_e_per_dn = 1, .bits = 16};
  const int count = 200000, bins = 12;
  for (const double mean_e : {1.0, 2.0}) {
    RandomStream random(4, 5, 6);
    std::vector<int> histogram(bins + 1, 0);
    for (int i = 0; i < count; ++i)
      ++histogram[std::min<int>(bins, read_pixel(sensor, {.read_noise = false}, mean_e, random))];
    double chi2 = 0, share = std::exp(-mean_e), rest = 1;
    for (int k = 0; k < bins; ++k) {
      chi2 += std::pow(histogram[k] - count * share, 2) / (count * share);
      rest -= share;
      share *= mean_e / (k + 1);
    }
    EXPECT_LT(chi2, 32.9) << mean_e;  // 0.1 % quantile of chi-square, 12 degrees of freedom
    EXPECT_LE(histogram[bins], 5 + 10 * count * rest);
  }
  RandomStream random(4, 5, 6);
  EXPECT_EQ(read_pixel(sensor, {}, 0, random), 0) << "no light, no shot noise";
}

// R12.
TEST(Detector, SaturatesAtTheFullWellAndAtTheLastNumber) {
  RandomStream random(7, 0, 0);
  const Sensor well{.gain_e_per_dn = 10, .offset_dn = 5, .full_well_e = 20000, .bits = 16};
  EXPECT_EQ(read_pixel(well, {}, 200000, random), 2005);
  const Sensor bits{.gain_e_per_dn = 10, .bits = 8};
  EXPECT_EQ(read_pixel(bits, {}, 200000, random), 255);
  const Sensor dark{.gain_e_per_dn = 10, .offset_dn = -100, .bits = 8};
  EXPECT_EQ(read_pixel(dark, {}, 20, random), 0);
}

TEST(Detector, RoundsToTheNearestNumber) {
  RandomStream random(8, 0, 0);
  const Sensor sensor{.gain_e_per_dn = 10, .offset_dn = 2, .bits = 8};
  EXPECT_EQ(read_pixel(sensor, no_effects, 34.9, random), 5);
  EXPECT_EQ(read_pixel(sensor, no_effects, 35.1, random), 6);
}

TEST(Detector, WithoutQuantisationDeliversFinerSteps) {
  RandomStream random(9, 0, 0);
  const Sensor sensor{.gain_e_per_dn = 40, .offset_dn = 3, .bits = 8};
  const DetectorEffects smooth{false, false, false};
  const Sensor delivered = delivered_sensor(sensor, smooth);
  for (double electrons = 0; electrons < 10000; electrons += 7.3) {
    const double dn = read_pixel(sensor, smooth, electrons, random);
    EXPECT_NEAR((dn - delivered.offset_dn) * delivered.gain_e_per_dn, electrons,
                40.0 / 64 / 2 + 1e-9);
  }
  EXPECT_EQ(delivered_sensor({.bits = 16}, smooth).bits, 16) << "a pixel holds no more";
  EXPECT_EQ(delivered_sensor(sensor, {}).bits, 8);
}

}  // namespace
}  // namespace scan::synth
