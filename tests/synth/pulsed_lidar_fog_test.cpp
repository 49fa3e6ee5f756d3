// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The lidar in fog.
#include <cmath>
#include <numeric>

#include "synth/scanners/pulsed_lidar_fog.h"
#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

const EffectSet with_fog = {Effect::quantisation, Effect::footprint, Effect::medium};

PulsedLidar one_beam() {
  PulsedLidar lidar = small_lidar();
  lidar.pattern = RasterPattern{.rows = 1, .columns = 1, .height_rad = 0, .width_rad = 0};
  lidar.ambient_electrons = 0;
  lidar.electrons_at_10m = 20000;
  lidar.sensor.gain_e_per_dn = 1.0 / 8;
  return lidar;
}

// Electrons of the only ray's samples.
std::vector<double> readings(const PulsedLidar& lidar, const Scene& scene,
                             const EffectSet& effects) {
  const auto frames =
      std::get<Waveforms>(render(lidar, RayCaster(scene), Pose::Identity(), {}, effects).frames);
  std::vector<double> electrons;
  for (const std::uint16_t dn : frames.samples)
    electrons.push_back(dn * frames.calibration.sensor.gain_e_per_dn);
  return electrons;
}

// Nothing but a target behind absorbing fog: exp(-2 alpha R), physics 7.7: MOR 100 m at 25 m,
// exp(-2 ln(20) / 4) = 0.2236. Rounding by 1/16 e in 28 samples of 716 e.
TEST(LidarFog, DimsAnEchoTwice) {
  Scene scene = scene_of(plane_at(25), 1);
  const double clear_e = 20000 * 100 / 625.0;
  scene.medium = fog(100, 0, 0);
  const auto samples = readings(one_beam(), scene, with_fog);
  const double sum_e = std::accumulate(samples.begin(), samples.end(), 0.0);
  EXPECT_NEAR(sum_e / clear_e, std::exp(-std::log(20.0) / 2), 28 / 16.0 / clear_e);
}

// In fog so thick that exp(-2 alpha 30 m) = 1e-8 the window holds all of it: the closed total, an
// exponential integral, to what lies beyond the window.
TEST(LidarFog, SendsBackWhatTheSoftTargetDoes) {
  PulsedLidar lidar = one_beam();
  lidar.overlap_m = 3;
  const Medium thick = fog(10, 0.5, 0.9);
  const SampleAxis axis = sample_axis(lidar);
  std::vector<double> samples(static_cast<std::size_t>(axis.samples));
  LidarFog(lidar, thick, axis).add(std::numeric_limits<double>::infinity(), samples);
  const double sum_e = std::accumulate(samples.begin(), samples.end(), 0.0);
  const SoftTarget target = soft_target(thick, 20000 * 100, 3);
  // sigma_s p(-1) = 0.9 alpha (1 - g^2) / (4 pi (1 + g)^3), alpha = ln(20) / 10 m.
  const double alpha = std::log(20.0) / 10;
  EXPECT_NEAR(target.backscatter_per_m_sr,
              0.9 * alpha * 0.75 / (4 * std::numbers::pi * std::pow(1.5, 3)), 1e-15);
  EXPECT_NEAR(sum_e / soft_target_total(target, std::numeric_limits<double>::infinity()), 1, 1e-8);
  EXPECT_GT(sum_e, 100);
}

// A target ends the fog: before it as without it, far behind it nothing, and in between half of
// what the endless fog would send at the target's own time (its near side).
TEST(LidarFog, EndsAtTheTarget) {
  const PulsedLidar lidar = one_beam();
  const SampleAxis axis = sample_axis(lidar);
  const LidarFog layer(lidar, fog(50, 0, 1), axis);
  const auto count = static_cast<std::size_t>(axis.samples);
  std::vector<double> endless(count), cut(count);
  layer.add(std::numeric_limits<double>::infinity(), endless);
  layer.add(15, cut);
  const double at = (2 * 15 / c - axis.start_s) / axis.interval_s;
  const auto middle = static_cast<std::size_t>(std::lround(at));
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 15 < middle) {
      EXPECT_EQ(cut[i], endless[i]) << i;
    }
    if (i > middle + 15) {
      EXPECT_EQ(cut[i], 0) << i;
    }
  }
  // Locally exp(-k r), k = 2 alpha + 2 / R = 0.253 / m; of a Gaussian of sigma = 0.225 m in range
  // the near side has Phi(k sigma) of it; the sample stands up to 0.5 beside the target: 0.07 m.
  const double share = cut[middle] / endless[middle];
  EXPECT_NEAR(share, 0.5, 0.5 * 0.075 / 0.225 + 0.03);
}

TEST(LidarFog, IsNotThereWhenOff) {
  Scene scene = scene_of(plane_at(12), 0.5);
  const auto clear = readings(one_beam(), scene, with_fog);
  scene.medium = fog(50, 0.3, 0.9);
  EXPECT_EQ(readings(one_beam(), scene, with_fog.without(Effect::medium)), clear);
  EXPECT_NE(readings(one_beam(), scene, with_fog), clear);
}

}  // namespace
}  // namespace scan::synth
