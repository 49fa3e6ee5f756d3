// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/waveform.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/acquire/reason.h"
#include "libscan/core/error.h"
#include "libscan/core/units.h"
#include "tests/acquire/readings.h"

namespace scan {
namespace {

constexpr PulseMethod methods[] = {PulseMethod::leading_edge, PulseMethod::centroid,
                                   PulseMethod::matched_filter};
constexpr double half_c = speed_of_light_m_s / 2;

struct Echo {
  double range_m, height_e;
};

struct Device {
  double interval_s = 1e-9, pulse_s = 2e-9, ambient_e = 5, start_s = 20e-9;
  Sensor sensor = {.gain_e_per_dn = 1, .offset_dn = 30};
  std::uint32_t samples = 120;
};

Waveforms record(const Device& device, const std::vector<std::vector<Echo>>& rays,
                 std::uint64_t seed = 0) {
  Waveforms frames;
  frames.calibration = {device.interval_s, device.start_s, device.pulse_s, device.sensor};
  frames.samples_per_ray = device.samples;
  frames.grid = {1, static_cast<std::uint32_t>(rays.size())};
  for (std::size_t ray = 0; ray < rays.size(); ++ray) {
    RandomStream random(seed, 1, ray);
    frames.directions.push_back(Eigen::Vector3d(0.1, -0.2, 1).normalized());
    for (std::uint32_t i = 0; i < device.samples; ++i) {
      double expected = device.ambient_e;
      for (const Echo& echo : rays[ray])
        expected += echo.height_e *
                    test::bell(device.start_s + i * device.interval_s - echo.range_m / half_c,
                               device.pulse_s);
      frames.samples.push_back(seed == 0 ? test::digitise(device.sensor, expected)
                                         : test::noisy(device.sensor, expected, random));
    }
  }
  return frames;
}

// Ranges over one sample step, noise-free. Rounding by 1/2 in each reading moves the
// maximum-likelihood time by at most 3 s / A (as in stripe_peak_test.cpp) and the half-height
// crossing by at most (1/2 + 1/2) / slope, slope = A sqrt(2 ln 2) / (2 s), again under 3 s / A; the
// centroid's window adds 5e-4 s (gaussian_fit_test.cpp).
TEST(Waveform, RecoversTheRangeToTheRounding) {
  const double height_e = 20'000;
  for (const double pulse_samples : {1.0, 2.0, 4.0}) {
    const Device device{.pulse_s = pulse_samples * 1e-9};
    std::vector<std::vector<Echo>> rays;
    for (int i = 0; i < 64; ++i) rays.push_back({{10 + i * half_c * 1e-9 / 64, height_e}});
    for (const PulseMethod method : methods) {
      const Scan scan = acquire_waveform(record(device, rays), {.pulse = method});
      ASSERT_EQ(scan.cloud.size(), rays.size());
      const double bound_s =
          device.pulse_s * (3 / height_e + (method == PulseMethod::centroid) * 5e-4);
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_NEAR(scan.cloud.points[i].norm(), rays[i][0].range_m, half_c * bound_s)
            << static_cast<int>(method) << " " << pulse_samples;
    }
  }
}

struct Statistics {
  double found = 0, spread_m2 = 0, chi_square = 0;
};

Statistics trials(const Device& device, double height_e, const WaveformOptions& options,
                  int count) {
  std::vector<std::vector<Echo>> rays;
  for (int i = 0; i < count; ++i) {
    RandomStream random(31, 0, i);
    rays.push_back({{8 + random.uniform(), height_e}});
  }
  const Scan scan = acquire_waveform(record(device, rays, 32), options);
  Statistics result;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const double error = scan.cloud.points[i].norm() - rays[scan.ray[i]][0].range_m;
    ++result.found;
    result.spread_m2 += error * error;
    result.chi_square += std::pow(error / scan.cloud.sigma_m[i], 2);
  }
  return result;
}

// Shot noise alone: sigma_t = s / sqrt(N), N the electrons of the echo (Cramer-Rao). The spread
// over 3,000 echoes has a relative standard deviation of 1.3 %: 0.95 to 1.05 is four of them.
TEST(MatchedFilter, AttainsTheShotNoiseBound) {
  const Device device{.ambient_e = 0};
  const double height_e = 500, electrons = height_e * 2 * std::sqrt(2 * M_PI);
  const Statistics result = trials(device, height_e, {}, 3000);
  EXPECT_EQ(result.found, 3000);
  const double bound_m = half_c * device.pulse_s / std::sqrt(electrons);
  EXPECT_NEAR(std::sqrt(result.spread_m2 / result.found) / bound_m, 1, 0.055);
}

// Strong ambient light and read noise: sigma_t^2 = v / sum m'^2, sum m'^2 = A^2 sqrt(pi) / (2 s)
// with s in samples. The pulse's own shot noise, A / v = 5 %, adds at most that.
TEST(MatchedFilter, AttainsTheAmbientBound) {
  const Device device{.ambient_e = 3000, .sensor = {.offset_dn = 500, .read_noise_e = 30}};
  const double height_e = 600, variance = 3000 + 900 + 1 / 12.0, s = 2;
  const Statistics result = trials(device, height_e, {}, 3000);
  EXPECT_GT(result.found, 2990);
  const double bound_samples =
      std::sqrt(variance / (height_e * height_e * std::sqrt(M_PI) / (2 * s)));
  const double ratio = std::sqrt(result.spread_m2 / result.found) / (half_c * 1e-9 * bound_samples);
  EXPECT_GT(ratio, 0.95);
  EXPECT_LT(ratio, 1.15);
}

// The background comes from about 100 samples (its variance by 14 %, but shot noise of the echo
// dominates) and errors are normal to first order: 12 % beside the statistics.
TEST(Waveform, ReportsItsScatter) {
  const Device device{.ambient_e = 20,
                      .sensor = {.gain_e_per_dn = 2, .offset_dn = 30, .read_noise_e = 5}};
  for (const PulseMethod method : methods) {
    const Statistics result = trials(device, 800, {.pulse = method}, 3000);
    EXPECT_EQ(result.found, 3000);
    EXPECT_NEAR(result.chi_square / result.found, 1, test::chi_square_margin(3000, 0.12))
        << static_cast<int>(method);
  }
}

// Two echoes, the second stronger: the first one counts once a valley parts them.
TEST(Waveform, TakesTheFirstOfTwoEchoes) {
  const Device device;
  for (const double separation_m : {2.0, 4.0})
    for (const PulseMethod method : methods) {
      const Scan scan = acquire_waveform(record(device, {{{8, 500}, {8 + separation_m, 2000}}}),
                                         {.pulse = method});
      ASSERT_EQ(scan.cloud.size(), 1u);
      EXPECT_NEAR(scan.cloud.points[0].norm(), 8, 0.05);
    }
}

// Light that falls from the record's first sample on, as from fog before the lens, is no echo; the
// wall behind it is found to its rounding (above) and what the falling light's slope pulls: at 18
// m, 280 exp(-12) e.
TEST(Waveform, LooksPastLightThatTheRecordBeginsWith) {
  const Device device;
  Waveforms frames = record(device, {{{15, 800}}});
  for (std::uint32_t i = 0; i < device.samples; ++i)
    frames.samples[i] += static_cast<std::uint16_t>(std::lround(280 * std::exp(-0.15 * i)));
  const Scan scan = acquire_waveform(frames);
  ASSERT_EQ(scan.cloud.size(), 1u);
  EXPECT_NEAR(scan.cloud.points[0].norm(), 15, half_c * 2e-9 * (3.0 / 800 + 0.01));
}

// Closer than a pulse they are one echo, between the two: the energy-weighted place.
TEST(Waveform, MergesEchoesWithinAPulse) {
  const Scan scan = acquire_waveform(record({}, {{{8, 1000}, {8.1, 1000}}}));
  ASSERT_EQ(scan.cloud.size(), 1u);
  EXPECT_NEAR(scan.cloud.points[0].norm(), 8.05, 1e-3);
}

// Equal echoes d apart leave humps of sigma' = sqrt(2) sigma in the correlation; at d = 3.6 sigma
// its valley lies at 2 exp(-d^2 / 8 sigma'^2) = 0.89 of a single hump's top, the tops at 1 +
// exp(-d^2 / 2 sigma'^2) = 1.04: 0.15 of 5300 e, over six times their noise, sqrt(5300) e. Range
// errors: rounding by 1/2 in each reading moves a single pulse by 3 s / A (above); two fits at 3.6
// sigma are correlated by exp(-(3.6 / 2)^2) = 0.04, three times that is more than enough.
TEST(Waveform, PartsTwoEqualEchoesBeyondTheirWidth) {
  const Device device{.pulse_s = 1.5e-9};
  std::vector<std::vector<Echo>> rays;
  for (double separation = 3.6; separation < 8; separation += 0.05)
    rays.push_back({{8.07, 2000}, {8.07 + separation * 1.5e-9 * half_c, 2000}});
  for (const PulseMethod method : methods) {
    const Scan scan = acquire_waveform(record(device, rays), {.pulse = method});
    ASSERT_EQ(scan.cloud.size(), rays.size()) << static_cast<int>(method);
    const double bound_s = 1.5e-9 * (9.0 / 2000 + (method == PulseMethod::centroid) * 5e-3);
    for (const Eigen::Vector3d& point : scan.cloud.points)
      EXPECT_NEAR(point.norm(), 8.07, half_c * bound_s) << static_cast<int>(method);
  }
}

// A record that begins later gives the same point; the pose of the ray carries it to the scan
// frame.
TEST(Waveform, PlacesGatesAndMovingRays) {
  const Waveforms whole = record({}, {{{8, 1000}}});
  Waveforms gate = whole;
  gate.samples.assign(whole.samples.begin() + 13, whole.samples.begin() + 63);
  gate.samples_per_ray = 50;
  gate.first_sample = {13};
  gate.scanner_from_ray = {exp((Vector6() << 0.3, -0.2, 0.5, 1, 2, 3).finished())};
  const Scan a = acquire_waveform(whole), b = acquire_waveform(gate);
  ASSERT_EQ(a.cloud.size(), 1u);
  ASSERT_EQ(b.cloud.size(), 1u);
  const Pose& pose = gate.scanner_from_ray[0];
  // The background's level differs by the rounding of 50 or 120 samples.
  EXPECT_LT((b.cloud.points[0] - pose * a.cloud.points[0]).norm(), 1e-5);
  const Eigen::Vector3d along = pose.linear() * gate.directions[0];
  EXPECT_NEAR(along.dot(b.cloud.covariances[0] * along), std::pow(b.cloud.sigma_m[0], 2), 1e-15);
}

// -0.2 ns per decade over 1000 e: an echo of 1e5 e comes 0.4 ns early and is put back.
TEST(Waveform, TakesBackTheRangeWalk) {
  const double height_e = 1e5 / (2 * std::sqrt(2 * M_PI));
  const double early_m = 0.4e-9 * half_c;
  Waveforms frames = record({}, {{{8 - early_m, height_e}}});
  EXPECT_NEAR(acquire_waveform(frames).cloud.points[0].norm(), 8 - early_m, 1e-4);
  frames.calibration.range_walk_s = -0.2e-9;
  EXPECT_NEAR(acquire_waveform(frames).cloud.points[0].norm(), 8, 1e-4);
}

std::string only_miss(const Waveforms& frames) {
  const Scan scan = acquire_waveform(frames);
  return scan.misses.size() == 1 && scan.cloud.empty() ? scan.misses.begin()->first : "";
}

TEST(Waveform, NamesTheReasonOfEachMiss) {
  EXPECT_EQ(only_miss(record({}, {{}})), reason::no_signal);
  EXPECT_EQ(only_miss(record({.sensor = {.full_well_e = 1000}}, {{{8, 10'000}}})),
            reason::saturated);
  EXPECT_EQ(only_miss(record(
                {
                    .sensor = {.full_well_e = 100},
                },
                {{{8, 1e9}}})),
            reason::saturated);
  const double start_m = half_c * 20e-9, end_m = start_m + half_c * 119e-9;
  EXPECT_EQ(only_miss(record({}, {{{start_m, 1000}}})), reason::border);
  EXPECT_EQ(only_miss(record({}, {{{end_m, 1000}}})), reason::border);
  EXPECT_EQ(only_miss(record({.start_s = -100e-9}, {{{-2, 1000}}})), reason::out_of_range);
}

TEST(Waveform, HasNoSignalInTheDark) {
  const std::vector<std::vector<Echo>> dark(3000);
  for (const double ambient : {0.0, 0.05, 1.0, 30.0})
    EXPECT_EQ(acquire_waveform(record({.ambient_e = ambient}, dark, 33)).cloud.size(), 0u)
        << ambient;
}

TEST(Waveform, StaysFiniteForFewPhotons) {
  Waveforms frames = record({.ambient_e = 0, .sensor = {}, .samples = 40},
                            std::vector<std::vector<Echo>>(40 * 40));
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      frames.samples[(i * 40 + j) * 40 + i] += 1;
      frames.samples[(i * 40 + j) * 40 + j] += 1;
    }
  for (const PulseMethod method : methods) {
    const Scan scan = acquire_waveform(frames, {.pulse = method, .threshold_sigmas = 1});
    std::size_t rays = scan.cloud.size();
    for (const auto& [reason, count] : scan.misses) rays += count;
    EXPECT_EQ(rays, 1600u);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i)
      EXPECT_TRUE(scan.cloud.points[i].allFinite() && std::isfinite(scan.cloud.sigma_m[i]) &&
                  scan.cloud.sigma_m[i] > 0);
  }
}

TEST(Waveform, RefusesBrokenFrames) {
  Waveforms frames = record({}, {{}});
  frames.samples.pop_back();
  EXPECT_THROW(acquire_waveform(frames), Error);
  frames = record({}, {{}});
  frames.directions[0] *= 3;
  EXPECT_THROW(acquire_waveform(frames), Error);
  frames = record({}, {{}});
  frames.grid = {2, 2};
  EXPECT_THROW(acquire_waveform(frames), Error);
  frames = record({}, {{}});
  frames.first_sample = {1, 2};
  EXPECT_THROW(acquire_waveform(frames), Error);
  frames = record({}, {{}});
  frames.scanner_from_ray.resize(3, Pose::Identity());
  EXPECT_THROW(acquire_waveform(frames), Error);
  frames = record({}, {{}});
  frames.calibration.range_walk_electrons = 0;
  EXPECT_THROW(acquire_waveform(frames), Error);
  frames = record({}, {{}});
  frames.calibration.pulse_sigma_s = 0;
  EXPECT_THROW(acquire_waveform(frames), Error);
}

}  // namespace
}  // namespace scan
