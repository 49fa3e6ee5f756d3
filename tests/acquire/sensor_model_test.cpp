// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/sensor_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libscan/core/error.h"
#include "tests/acquire/readings.h"

namespace scan::decoding {
namespace {

TEST(Sensor, ElectronsInvertTheDetector) {
  const Sensor sensor{.gain_e_per_dn = 4, .offset_dn = 64};
  EXPECT_EQ(test::digitise(sensor, 400), 164);
  EXPECT_DOUBLE_EQ(electrons(sensor, 164), 400);
}

TEST(Sensor, VarianceIsShotPlusReadPlusRounding) {
  const Sensor sensor{.gain_e_per_dn = 6, .read_noise_e = 5};
  EXPECT_DOUBLE_EQ(variance_e2(sensor, 100), 100 + 25 + 3);
  EXPECT_DOUBLE_EQ(variance_e2(sensor, -1), 25 + 3);  // a negative reading has no shot noise
}

TEST(Sensor, SaturatesAtTheFullWellOrTheLastNumber) {
  EXPECT_EQ(saturation_dn({.gain_e_per_dn = 2, .offset_dn = 10, .full_well_e = 1000, .bits = 12}),
            510);
  EXPECT_EQ(saturation_dn({.gain_e_per_dn = 2, .bits = 12}), 4095);
}

TEST(Sensor, RefusesFieldsOutOfTheirDomain) {
  EXPECT_THROW(check({.gain_e_per_dn = 0}), Error);
  EXPECT_THROW(check({.offset_dn = NAN}), Error);
  EXPECT_THROW(check({.read_noise_e = -1}), Error);
  EXPECT_THROW(check({.full_well_e = 0}), Error);
  EXPECT_THROW(check({.bits = 17}), Error);
  EXPECT_NO_THROW(check(Sensor{}));
}

// 4,000 Poisson readings of mean 50 with read noise 5, a third of them covered by a bright signal.
// Clipping at three sigma keeps 99.7 % and lowers the variance by under 3 %; the mean's own sigma
// is sqrt(75 / 2600) = 0.17 e.
TEST(Background, IsNotMovedByTheSignal) {
  const Sensor sensor{.read_noise_e = 5};
  RandomStream random(1, 0, 0);
  std::vector<double> row;
  for (int i = 0; i < 4000; ++i)
    row.push_back(test::noisy({.offset_dn = 100, .read_noise_e = 5}, i < 1300 ? 3000 : 50, random) -
                  100.0);
  const Background background = estimate_background(row, sensor);
  EXPECT_NEAR(background.level_e, 50, 1);
  EXPECT_NEAR(background.variance_e2, 75, 6);
}

// Mean 0.1 e: the median is 0, yet the mean is found: 5 sigma of 10,000 draws are 0.016.
TEST(Background, SeesAMeanBelowOneElectron) {
  RandomStream random(2, 0, 0);
  std::vector<double> row;
  for (int i = 0; i < 10'000; ++i) row.push_back(static_cast<double>(random.poisson(0.1)));
  EXPECT_NEAR(estimate_background(row, Sensor{}).level_e, 0.1, 0.016);
}

// The normal limit, and the Poisson limit: P(N >= 0.1 + t) for mean 0.1 must be below the normal
// tail at 6 sigma, 1e-9; t + 0.1 = 8 photons have 0.1^8 / 8! = 2.5e-13.
TEST(Background, ThresholdHoldsForFewPhotons) {
  const Background many{.level_e = 0, .variance_e2 = 100, .shot_share = 0};
  EXPECT_DOUBLE_EQ(many.threshold_e(6, 4), 120);
  const Background few{.level_e = 0.1, .variance_e2 = 0.1, .shot_share = 1};
  const int photons = static_cast<int>(std::ceil(few.threshold_e(6, 1) + 0.1));
  double tail = 0;
  for (int n = photons; n < photons + 20; ++n)
    tail += std::exp(-0.1 + n * std::log(0.1) - std::lgamma(n + 1));
  EXPECT_LT(tail, 1e-9);
}

}  // namespace
}  // namespace scan::decoding
