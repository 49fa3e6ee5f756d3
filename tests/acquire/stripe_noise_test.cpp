// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What noise in stripes does to the shifts that are told by them.
#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/random.h"
#include "tests/acquire/stripe_sweep.h"

namespace scan::decoding {
namespace {

// A column that is off by so much: the point has moved within the plane of light, along (0.6, 0,
// -0.8), 200 * 0.6 columns a metre.
void add_noise(LitRay& ray, double column_px, double log_height) {
  ray.column_px += column_px;
  ray.point += column_px / 120 * Eigen::Vector3d(0.6, 0, -0.8);
  ray.height_e *= std::exp(log_height);
}

constexpr double noise_px = 0.01;

Sweep noisy_sweep(std::size_t rows) {
  Sweep sweep = sweep_over_rows(25, rows);
  for (std::size_t i = 0; i < sweep.rays.size(); ++i) {
    RandomStream random(3, 0, i);
    sweep.rays[i].sigma_px = noise_px;
    sweep.rays[i].width_px = 1.6;  // four widths are four steps, clear of three and of five
    const double log_height = std::sqrt(1.5) * noise_px / sweep.rays[i].width_px;
    add_noise(sweep.rays[i], noise_px * random.normal(), log_height * random.normal());
  }
  return sweep;
}

// Stripes of a plane with independent normal noise, one ray each of 4000 rows: the squares over
// their variances have the mean 1 to five times sqrt(2 / 4000). Other steps see a column's error
// 200 (0.6 + 0.8 x) long for 120, which is 8 % at the places beyond; on the other side it is as
// much too short, so that its square, 0.6 %, is left.
TEST(StripeShift, VarianceIsThatOfItsNoise) {
  const std::size_t rows = 4000, step = 12;
  const Sweep sweep = noisy_sweep(rows);
  double of_shift = 0, of_ahead = 0, of_behind = 0;
  const auto square = [](double value, double variance) { return value * value / variance; };
  for (std::size_t row = 0; row < rows; ++row) {
    const StripeShift shift = stripe_shift(sweep.frames, sweep.rays, step * rows + row).value();
    const auto& [ahead, behind] = shift.departures.value();
    of_shift += square(shift.shift_px, shift.variance_px2) / rows;
    of_ahead += square(ahead.value_px, ahead.variance_px2) / rows;
    of_behind += square(behind.value_px, behind.variance_px2) / rows;
  }
  const double tolerance = 5 * std::sqrt(2.0 / rows) + 0.006;
  EXPECT_NEAR(of_shift, 1, tolerance);
  EXPECT_NEAR(of_ahead, 1, tolerance);
  EXPECT_NEAR(of_behind, 1, tolerance);
}

// The mean over twelve rows, at every thirteenth of them, where the means share none: 1538. What is
// unknown besides its noise is on average the positive part of d^2 / v - 1 of the larger of two
// departures d with the variance v: for one of them 2 phi(1) = 0.48, for both at most 0.97, where
// d^2 / v itself is 1 and more. Its standard deviation is 2 at most.
TEST(StripeShifts, VarianceIsThatOfTheMean) {
  const std::size_t rows = 20'000, first = 12 * rows;
  const Sweep sweep = noisy_sweep(rows);
  const auto shifts = stripe_shifts(sweep.frames, sweep.rays);
  double of_mean = 0, of_misfit = 0, count = 0;
  for (std::size_t ray = first + 6; ray + 6 < first + rows; ray += 13) {
    const StripeShift own = stripe_shift(sweep.frames, sweep.rays, ray).value();
    const StripeShift& mean = shifts[ray].value();
    const auto& [ahead, behind] = own.departures.value();
    const double departure_px2 = std::max(ahead.variance_px2, behind.variance_px2) / 12;
    of_mean += mean.shift_px * mean.shift_px / mean.variance_px2;
    of_misfit += (mean.unknown_px * mean.unknown_px - mean.variance_px2) / departure_px2;
    ++count;
  }
  EXPECT_NEAR(of_mean / count, 1, 5 * std::sqrt(2 / count) + 0.006);
  EXPECT_GT(of_misfit / count, 0.48 - 5 * 2 / std::sqrt(count));
  EXPECT_LT(of_misfit / count, 0.97 + 5 * 2 / std::sqrt(count));
}

}  // namespace
}  // namespace scan::decoding
