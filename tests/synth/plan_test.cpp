// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "synth/detector.h"
#include "synth/effects/sensitivity.h"

namespace scan::synth {
namespace {

LaserLine laser() {
  return {.camera = {640, 480, 800, 800, 319.5, 239.5},
          .sensor = {.gain_e_per_dn = 20, .read_noise_e = 30, .bits = 10}};
}

std::vector<Scanner> every_scanner() {
  StereoPair stereo;
  stereo.calibration = {.width_px = 64,
                        .height_px = 48,
                        .focal_px = 60,
                        .cx_px = 31.5,
                        .cy_px = 23.5,
                        .baseline_m = 0.1,
                        .disparities_px = 16};
  PhaseCamera phase{.camera = {64, 48, 60, 60, 31.5, 23.5}, .sensor = {}};
  return {laser(), stereo, phase,
          PulsedLidar{.pattern = RasterPattern{4, 4, 0.1, 0.1}, .sensor = {}}};
}

const EffectDecision& named(const EffectPlan& plan, const std::string& effect) {
  for (const EffectDecision& decision : plan)
    if (name(decision.effect) == effect) return decision;
  throw std::out_of_range(effect);
}

TEST(EffectPlan, DecidesEachEffectForEachScannerWithAReason) {
  for (const Scanner& scanner : every_scanner()) {
    const EffectPlan plan = plan_effects(scanner, Scene{}, {}, {});
    ASSERT_EQ(plan.size(), 4u);
    for (const EffectDecision& decision : plan) {
      EXPECT_GE(decision.bound_m, 0);
      EXPECT_TRUE(std::isfinite(decision.bound_m));
      EXPECT_EQ(decision.reason.back(), '.');
    }
    EXPECT_TRUE(named(plan, "shot noise").on) << "light is never without it";
    EXPECT_TRUE(named(plan, "shot noise").bound_m > 0);
  }
}

TEST(EffectPlan, LeavesOutWhatIsBelowAPercentOfSigma) {
  LaserLine scanner = laser();
  EXPECT_TRUE(named(plan_effects(scanner, Scene{}, {}, {}), "read noise").on);
  scanner.sensor.read_noise_e = 0;
  const EffectPlan without = plan_effects(scanner, Scene{}, {}, {});
  EXPECT_FALSE(named(without, "read noise").on);
  EXPECT_EQ(named(without, "read noise").bound_m, 0);
  EXPECT_NE(named(without, "read noise").reason.find("Off"), std::string::npos);
  scanner.sensor.gain_e_per_dn = 1e-3;
  EXPECT_FALSE(named(plan_effects(scanner, Scene{}, {}, {}), "quantisation").on);
  EXPECT_FALSE(detector_effects(effects_of(plan_effects(scanner, Scene{}, {}, {}))).quantisation);
}

// Just on either side of the limit, by the plan's own figures.
TEST(EffectPlan, SwitchesAtTheLimitItStates) {
  const auto share = [](const LaserLine& scanner) {
    double largest = 0;
    for (const Sensitivity& point : sensitivities(scanner)) {
      const double step_e = scanner.sensor.gain_e_per_dn;
      const double white_e = std::hypot(scanner.sensor.read_noise_e, step_e / std::sqrt(12));
      const double sigma_m = std::hypot(point.shot_m, white_e * point.per_electron_m);
      largest = std::max(largest, 3 * scanner.sensor.read_noise_e * point.per_electron_m / sigma_m);
    }
    return largest;
  };
  LaserLine scanner = laser();
  for (double noise_e = 1e-3; noise_e < 100; noise_e *= 1.3) {
    scanner.sensor.read_noise_e = noise_e;
    EXPECT_EQ(named(plan_effects(scanner, Scene{}, {}, {}), "read noise").on,
              share(scanner) >= 0.01)
        << noise_e;
  }
}

TEST(EffectPlan, FollowsAnExplicitChoice) {
  using Kind = EffectChoice::Kind;
  const LaserLine scanner = laser();
  for (const auto& decision : plan_effects(scanner, Scene{}, {}, {Kind::all, {}}))
    EXPECT_TRUE(decision.on);
  for (const auto& decision : plan_effects(scanner, Scene{}, {}, {Kind::none, {}}))
    EXPECT_EQ(decision.on, decision.effect == Effect::footprint);
  const EffectPlan plan =
      plan_effects(scanner, Scene{}, {}, {Kind::named, {"read-noise", "quantisation"}});
  EXPECT_FALSE(named(plan, "shot noise").on);
  EXPECT_TRUE(named(plan, "read noise").on);
  EXPECT_TRUE(named(plan, "quantisation").on);
  const DetectorEffects effects = detector_effects(effects_of(plan));
  EXPECT_FALSE(effects.shot_noise);
  EXPECT_TRUE(effects.read_noise);
  EXPECT_TRUE(effects.quantisation);
}

TEST(EffectPlan, NamesTheNearestKnownEffect) {
  try {
    plan_effects(laser(), Scene{}, {}, {EffectChoice::Kind::named, {"shot nose"}});
    FAIL() << "an unknown name must be refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::usage);
    EXPECT_NE(std::string(error.what()).find("shot nose"), std::string::npos);
    EXPECT_EQ(error.hint(), "did you mean 'shot noise'?");
  }
}

// The laser's figures against the least-squares fit itself: a Gaussian of the same width, sampled
// per pixel, its slope matched to the error.
TEST(Sensitivity, OfThePeakIsThatOfTheLeastSquaresFit) {
  const LaserLine scanner = laser();
  const double z = scanner.baseline_m / std::tan(scanner.triangulation_rad);
  const double stripe_px =
      scanner.beam_radius_m / 2 / std::cos(scanner.triangulation_rad) * 800 / z;
  const double s = std::sqrt(stripe_px * stripe_px + 1.0 / 12), height = scanner.peak_electrons;
  double slope2 = 0, slope1 = 0, shot = 0;
  const double step = 1e-3;
  for (double x = -10 * s; x <= 10 * s; x += step) {
    const double value = height * std::exp(-x * x / (2 * s * s)), slope = -x / (s * s) * value;
    slope2 += slope * slope * step;
    slope1 += std::abs(slope) * step;
    shot += value > 0 ? slope * slope / value * step : 0;
  }
  const double m_per_px = z * z / (scanner.baseline_m * 800);
  const Sensitivity bright = sensitivities(scanner).front();
  EXPECT_NEAR(bright.per_electron_m, m_per_px / std::sqrt(slope2), 1e-6 * bright.per_electron_m);
  EXPECT_NEAR(bright.worst_per_electron_m, m_per_px * slope1 / slope2,
              1e-5 * bright.worst_per_electron_m);
  EXPECT_NEAR(bright.shot_m, m_per_px / std::sqrt(shot), 1e-6 * bright.shot_m);
}

TEST(Sensitivity, OfThePhaseIsThatOfTheArcTangent) {
  PhaseCamera scanner{
      .camera = {64, 48, 60, 60, 31.5, 23.5}, .frequencies_hz = {40e6}, .sensor = {}};
  const Sensitivity near = sensitivities(scanner).front();
  const double amplitude = scanner.contrast * scanner.electrons_at_1m, phi = 0.7, h = 1e-3;
  double squares = 0;
  for (int k = 0; k < 4; ++k) {
    double taps[4];
    for (int j = 0; j < 4; ++j)
      taps[j] = amplitude * std::cos(phi + j * std::numbers::pi / 2) + (j == k ? h : 0);
    squares += std::pow((std::atan2(taps[3] - taps[1], taps[0] - taps[2]) - phi) / h, 2);
  }
  const double m_per_rad = 299792458 / (4 * std::numbers::pi * 40e6);
  EXPECT_NEAR(near.per_electron_m, m_per_rad * std::sqrt(squares), 1e-6 * near.per_electron_m);
}

}  // namespace
}  // namespace scan::synth
