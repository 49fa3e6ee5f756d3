// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/soft_target.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "libscan/core/units.h"
#include "tests/synth/stream_mean.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double sigma_s = 3e-9;

double delay_s(double range_m) {
  return 2 * range_m / speed_of_light_m_s;
}

// Dense fog, 50 m; 1e6 electrons from a white target at 1 m.
SoftTarget target() {
  return soft_target(fog(50, 0.7, 0.95), 1e6, 2);
}

// The return at one time after the other, directly: the pulse's density at time t, integrated by
// the trapezium rule over range, then Simpson's rule over time. Both rules converge faster than any
// power here except for the cut at near and far, where the trapezium's error is h^2 / 12 times the
// jump in slope.
double by_direct_integration(const SoftTarget& t, double far_m, double begin_s, double end_s) {
  const int ranges = 20000, times = 40;
  const double end_m = std::min(far_m, 15.0), h = (end_m - t.near_m) / ranges;
  double sum = 0;
  for (int k = 0; k <= times; ++k) {
    const double time_s = begin_s + (end_s - begin_s) * k / times;
    double power = 0;
    for (int i = 0; i <= ranges; ++i) {
      const double r = t.near_m + i * h;
      const double z = (time_s - delay_s(r)) / sigma_s;
      power += (i == 0 || i == ranges ? 0.5 : 1) * h * pi * t.backscatter_per_m_sr *
               t.white_electrons_at_1m * std::exp(-2 * t.extinction_per_m * r) / (r * r) *
               std::exp(-z * z / 2) / (sigma_s * std::sqrt(2 * pi));
    }
    sum += power * (k == 0 || k == times ? 1 : k % 2 ? 4 : 2) * (end_s - begin_s) / times / 3;
  }
  return sum;
}

TEST(SoftTarget, AgreesWithDirectIntegration) {
  const SoftTarget t = target();
  for (const double far_m : {6.0, infinity})
    for (const double begin_m : {0.5, 1.9, 4.0, 6.3}) {
      const double begin_s = delay_s(begin_m), end_s = begin_s + 2e-9;
      const double direct = by_direct_integration(t, far_m, begin_s, end_s);
      // trapezium: h^2 / 12 times the slope at the cut over the integral, at z sigmas (z / 0.45
      // m)^2 with h = 0.65 mm, z <= 3.4: 2e-6. Simpson: steps of 1/60 sigma, (z / 60)^4 / 180:
      // 1e-7. Beyond 15 m the pulse is 9 sigmas away.
      EXPECT_NEAR(soft_target_electrons(t, far_m, sigma_s, begin_s, end_s), direct,
                  3e-6 * direct + 1e-9 * soft_target_total(t, far_m))
          << far_m << " " << begin_m;
    }
}

// All samples together are the closed form with the exponential integral.
TEST(SoftTarget, AddsUpToItsTotal) {
  for (const double optical_range_m : {5.0, 50.0, 2000.0})
    for (const double near_m : {0.01, 2.0})
      for (const double far_m : {near_m / 2, 3.0, 40.0, 400.0}) {
        const SoftTarget t = soft_target(fog(optical_range_m, 0.7, 0.95), 1e6, near_m);
        double sum = 0;
        const double begin_s = -30e-9, step_s = 1e-9;
        for (int i = 0; i < 2800; ++i)
          sum += soft_target_electrons(t, far_m, sigma_s, begin_s + i * step_s,
                                       begin_s + (i + 1) * step_s);
        EXPECT_NEAR(sum, soft_target_total(t, far_m), 1e-9 * soft_target_total(t, infinity))
            << optical_range_m << " " << near_m << " " << far_m;
      }
}

// Photons that fly by sample_flight(): from where one is scattered, the share that a white target's
// light would send to the device, pi p(back), weakened on the way home.
TEST(SoftTarget, AgreesWithSingleScatteringByChance) {
  const Medium medium = fog(50, 0.7, 0.95);
  const SoftTarget t = target();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  for (const double begin_m : {1.8, 5.0, 20.0}) {
    const double begin_s = delay_s(begin_m), end_s = begin_s + 4e-9;
    const StreamMean walk = stream_mean(8192, [&](SampleSequence& random) {
      const Flight flight = sample_flight(medium, Eigen::Vector3d::Zero(), ahead, 60, random);
      if (!flight.scattered_m || *flight.scattered_m < t.near_m) return 0.0;
      const double r = *flight.scattered_m;
      const Eigen::Vector3d x = r * ahead;
      const double home = transmittance(medium, x, Eigen::Vector3d::Zero(), random);
      const double share = 0.5 * (std::erf((end_s - delay_s(r)) / (std::sqrt(2.0) * sigma_s)) -
                                  std::erf((begin_s - delay_s(r)) / (std::sqrt(2.0) * sigma_s)));
      return 1e6 * pi * flight.weight * phase_value(medium.phase, -1) * home / (r * r) * share;
    });
    EXPECT_NEAR(soft_target_electrons(t, 60, sigma_s, begin_s, end_s), walk.mean, 4.5 * walk.error)
        << begin_m;
    EXPECT_LT(walk.error, 0.02 * walk.mean);
  }
}

// A sphere of scatterers around a real receiver: photons flown, scattered by sample_phase() and
// counted if they fly into an aperture of radius 0.5 m from ranges of 8 m and more.
TEST(SoftTarget, AgreesWithCountedPhotons) {
  const Medium medium{.scattering_per_m = 0.05, .phase = HenyeyGreenstein{-0.5}};
  const double aperture_m = 0.5, near_m = 8, far_m = 30;
  const StreamMean counted = stream_mean(16384, [&](SampleSequence& random) {
    const Flight flight =
        sample_flight(medium, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), far_m, random);
    const Eigen::Vector2d u = random.next_2d();
    if (!flight.scattered_m || *flight.scattered_m < near_m) return 0.0;
    const Eigen::Vector3d back = sample_phase(medium.phase, Eigen::Vector3d::UnitZ(), u);
    if (back.z() >= 0) return 0.0;
    const double miss_m = *flight.scattered_m * back.head<2>().norm() / -back.z();
    return miss_m < aperture_m ? std::exp(-0.05 * *flight.scattered_m) : 0;
  });
  // a white target at 1 m sends area / pi of the photons into a small aperture
  const double white = aperture_m * aperture_m;
  const SoftTarget t = soft_target(medium, white, near_m);
  // the aperture seen from 8 m: solid angle, phase and slant differ from a far one's by
  // (0.5 / 8)^2 of order 1
  EXPECT_NEAR(soft_target_total(t, far_m), counted.mean,
              4.5 * counted.error + 0.004 * counted.mean);
  EXPECT_LT(counted.error, 0.03 * counted.mean);
}

// Clear air that scatters next to nothing: beta c / 2 per second over range squared.
TEST(SoftTarget, FollowsTheLidarEquation) {
  const SoftTarget t{.white_electrons_at_1m = 1e6,
                     .backscatter_per_m_sr = 1e-6,
                     .extinction_per_m = 1e-3,
                     .near_m = 1};
  const double r = 80;
  const double expected =
      pi * 1e-6 * 1e6 * std::exp(-0.16) / (r * r) * speed_of_light_m_s / 2 * 1e-10;
  // over a pulse of 0.15 m the curvature of 1 / R^2 is 3 (0.15 / 80)^2, with the exponential 1.2e-5
  EXPECT_NEAR(
      soft_target_electrons(t, infinity, 1e-9, delay_s(r) - 5e-11, delay_s(r) + 5e-11) / expected,
      1, 1.5e-5);
  EXPECT_EQ(soft_target_electrons(t, 0.5, 1e-9, 0, 1e-6), 0) << "the wall stands nearer than that";
  EXPECT_EQ(soft_target_electrons({}, infinity, 1e-9, 0, 1e-6), 0);
  EXPECT_EQ(soft_target_total(t, 0.5), 0);
}

}  // namespace
}  // namespace scan::synth
