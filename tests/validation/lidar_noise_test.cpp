// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The lidar's noise from scene to points: timing, its fall with intensity, the chance of an echo to
// be found.
#include <cmath>
#include <numbers>

#include "libscan/acquire/reason.h"
#include "libscan/core/units.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr double half_c = speed_of_light_m_s / 2;

// All rays from the middle of a sphere: one range, 3000 echoes of the same energy.
struct Trial {
  double sigma_m = 0;  // scatter of the ranges
  double mean_m = 0;
  double found = 0;     // points
  double detected = 0;  // rays with a signal
  double rays = 0;
};

Trial trial(PulsedLidar s, double albedo, const EffectSet& effects, std::uint64_t seed) {
  s.pattern = RasterPattern{.rows = 50, .columns = 60, .height_rad = 1, .width_rad = 1};
  const RayCaster caster({.objects = {sphere_at({0, 0, 0}, 10)}, .materials = {plain(albedo)}});
  const Scan scan =
      acquire(render(s, caster, Pose::Identity(), {.seed = seed, .scan = 0}, effects).frames);
  Trial result{.found = static_cast<double>(scan.cloud.size()), .detected = 3000, .rays = 3000};
  const auto dark = scan.misses.find(std::string(reason::no_signal));
  if (dark != scan.misses.end()) result.detected -= static_cast<double>(dark->second);
  double sum = 0, square = 0;
  for (const Eigen::Vector3d& point : scan.cloud.points) {
    sum += point.norm() - 10;
    square += std::pow(point.norm() - 10, 2);
  }
  result.mean_m = sum / result.found;
  result.sigma_m = std::sqrt(square / result.found - result.mean_m * result.mean_m);
  return result;
}

PulsedLidar lidar() {
  PulsedLidar s;
  s.ambient_electrons = 0;
  s.max_range_m = 20;
  s.sensor = {.gain_e_per_dn = 0.5, .offset_dn = 400, .bits = 16};
  return s;
}

const EffectSet shot = {Effect::shot_noise, Effect::quantisation};
const EffectSet read = {Effect::read_noise, Effect::quantisation};

// Shot noise: sigma_R = c / 2 sigma / sqrt(N) (Cramer-Rao), sigma the recorded pulse's. 3000 ranges
// tell it to 1 / sqrt(6000) = 1.3 %; four of these; for 3000 electrons and more the bound is met to
// a share of 1 / N^(1/2) = 2 %.
TEST(LidarNoise, IsTheShotNoiseBound) {
  const PulsedLidar s = lidar();
  const double pulse_s = std::hypot(s.pulse_sigma_s, s.sample_interval_s / std::sqrt(12.0));
  for (const double albedo : {0.6, 1.0}) {
    const Trial t = trial(s, albedo, shot, 5);
    EXPECT_EQ(t.found, t.rays);
    const double bound_m = half_c * pulse_s / std::sqrt(5000 * albedo);
    EXPECT_NEAR(t.sigma_m / bound_m, 1, 4 / std::sqrt(2 * t.rays) + 0.02);
    EXPECT_NEAR(t.mean_m, 0, 5 * bound_m / std::sqrt(t.rays) + 2e-5);
  }
}

// Read noise v: sigma_t^2 = v / sum m'^2 = 2 w v / (sqrt(pi) A^2) samples^2: sigma_R proportional
// to 1 / SNR, of which c t_rise / (2 SNR) (physics 7.4) is the rule of thumb.
TEST(LidarNoise, IsTheReadNoiseBound) {
  PulsedLidar s = lidar();
  s.sensor.read_noise_e = 40;
  const double width = std::hypot(1.5, std::sqrt(1.0 / 12));
  for (const double albedo : {0.5, 1.0}) {
    const Trial t = trial(s, albedo, read, 6);
    EXPECT_EQ(t.found, t.rays);
    const double height_e = 5000 * albedo / (width * std::sqrt(2 * pi));
    const double bound_m = half_c * 1e-9 * std::sqrt(2 * width / std::sqrt(pi)) * 40 / height_e;
    // the fit's weights count on shot noise as well: up to 1 + A / (4 v) over the least variance
    EXPECT_GT(t.sigma_m / bound_m, 1 - 4 / std::sqrt(2 * t.rays));
    EXPECT_LT(t.sigma_m / bound_m, 1 + 4 / std::sqrt(2 * t.rays) + height_e / (4 * 1600));
  }
}

// sigma = a I^b (Wujanz et al. 2017): b from -1/2 (shot noise) to -1 (read noise), and in between
// with both. Two intensities a factor 8 apart, each sigma to 1.3 %: b to 0.013 sqrt(2) / ln(8) =
// 0.009; four of these.
TEST(LidarNoise, IsAPowerOfTheIntensity) {
  const auto exponent = [](const PulsedLidar& s, const EffectSet& effects) {
    const Trial dim = trial(s, 0.12, effects, 7), bright = trial(s, 0.96, effects, 8);
    return std::log(bright.sigma_m / dim.sigma_m) / std::log(8.0);
  };
  PulsedLidar s = lidar();
  s.electrons_at_10m = 20000;
  EXPECT_NEAR(exponent(s, shot), -0.5, 0.036 + 0.01);
  s.sensor.read_noise_e = 60;
  EXPECT_NEAR(exponent(s, read), -1, 0.036 + 0.03);
  const double both = exponent(s, {Effect::shot_noise, Effect::read_noise, Effect::quantisation});
  EXPECT_LT(both, -0.55);
  EXPECT_GT(both, -0.95);
}

// An echo of N photons on the average and no other light or noise: with a threshold below what one
// photon gives (1 of the correlation against sigmas sqrt(sum w^2 gain^2 / 12) = 0.48) the decoder
// finds no signal only if none came, exp(-N); binomial over 3000 rays.
TEST(LidarNoise, LosesEchoesAsPoissonSays) {
  PulsedLidar s = lidar();
  s.sensor = {.gain_e_per_dn = 1, .offset_dn = 0, .bits = 16};
  s.pattern = RasterPattern{.rows = 50, .columns = 60, .height_rad = 1, .width_rad = 1};
  for (const double electrons : {0.2, 0.7, 2.0}) {
    const RayCaster caster(
        {.objects = {sphere_at({0, 0, 0}, 10)}, .materials = {plain(electrons / 5000)}});
    const Scan scan =
        acquire(render(s, caster, Pose::Identity(), {.seed = 9, .scan = 0}, shot).frames,
                {.waveform = {.threshold_sigmas = 1}});
    const auto lost = static_cast<double>(scan.misses.at(std::string(reason::no_signal)));
    const double chance = std::exp(-electrons);
    EXPECT_NEAR(lost / 3000, chance, 4 * std::sqrt(chance * (1 - chance) / 3000)) << electrons;
  }
}

// White noise v per sample: the correlation's top is normal about d = A sqrt(sum w^2 / v) of its
// sigmas, less 2.7 % where the echo stands between two samples; the threshold k = 6 is exceeded
// there with the chance Phi(d - k), and by the largest of the correlated values about it with
// little more: as if d were 0.4 larger. Binomial over 3000 rays.
TEST(LidarNoise, FindsWeakEchoesAsTheNormalLawSays) {
  PulsedLidar s = lidar();
  s.sensor.read_noise_e = 40;
  s.max_range_m = 100;
  const double width = std::hypot(1.5, std::sqrt(1.0 / 12)), weight2 = width * std::sqrt(pi);
  const auto chance = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  for (const double d : {5.0, 6.0, 7.0}) {
    const double height_e = d * 40 / std::sqrt(weight2);
    const Trial t = trial(s, height_e * width * std::sqrt(2 * pi) / 5000, read, 10);
    const double error = 4 * std::sqrt(0.25 / 3000);
    EXPECT_GT(t.detected / 3000, chance(0.973 * 0.992 * d - 6.07) - error) << d;
    EXPECT_LT(t.detected / 3000, chance(d - 6 + 0.4) + error) << d;
  }
}

}  // namespace
}  // namespace scan::synth
