// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The lidar's range walk and its gate.
#include <cmath>

#include "synth/scanners/pulsed_lidar_walk.h"
#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

const EffectSet with_walk = {Effect::quantisation, Effect::footprint, Effect::range_walk};

Waveforms frames_of(const PulsedLidar& lidar, const Scene& scene, const EffectSet& effects) {
  return std::get<Waveforms>(
      render(lidar, RayCaster(scene), Pose::Identity(), {.seed = 4}, effects).frames);
}

// -0.3 ns per decade from 100 e on: echoes of 10, 100 and 10^5 e come 0.3 ns late, in time, and
// 0.9 ns early; of less than an electron as of one, 0.6 ns late.
TEST(RangeWalk, IsALogarithmOfTheEnergy) {
  const RangeWalk walk{.per_decade_s = -0.3e-9, .at_electrons = 100};
  std::vector<Echo> echoes = {
      {200e-9, 1e5, 1e-9}, {50e-9, 10, 1e-9}, {300e-9, 0.01, 1e-9}, {100e-9, 100, 1e-9}};
  const auto pulses = delayed_pulses(walk, 1e-9, echoes);
  const double expected_s[] = {50.3e-9, 100e-9, 199.1e-9, 300.6e-9};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(echoes[i].time_s + delay_s(pulses, echoes[i].time_s), expected_s[i], 1e-20);
}

// Three echoes within 4 sigma of each other are one of 1000 e to the detector.
TEST(RangeWalk, TakesCloseEchoesAsOne) {
  const RangeWalk walk{.per_decade_s = -0.3e-9, .at_electrons = 100};
  std::vector<Echo> echoes = {
      {57e-9, 300, 1e-9}, {50e-9, 500, 1e-9}, {53.5e-9, 200, 1e-9}, {62e-9, 1000, 1e-9}};
  const auto pulses = delayed_pulses(walk, 1e-9, echoes);
  const double expected_s[] = {49.7e-9, 53.2e-9, 56.7e-9, 61.7e-9};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(echoes[i].time_s + delay_s(pulses, echoes[i].time_s), expected_s[i], 1e-20);
  EXPECT_EQ(delay_s({}, 50e-9), 0);
}

// A white and a dark plane at one range: N = 5000 and 50 e, two decades, 0.4 ns.
TEST(RangeWalk, MovesTheWaveform) {
  PulsedLidar lidar = small_lidar();
  lidar.pattern = RasterPattern{.rows = 1, .columns = 1, .height_rad = 0, .width_rad = 0};
  lidar.ambient_electrons = 0;
  lidar.sensor.gain_e_per_dn = 1.0 / 32;
  lidar.range_walk = {.per_decade_s = -0.2e-9, .at_electrons = 5000};
  double time_s[2];
  for (const bool dark : {false, true}) {
    const Waveforms frames = frames_of(lidar, scene_of(plane_at(10), dark ? 0.01 : 1), with_walk);
    EXPECT_EQ(frames.calibration.range_walk_s, 0);
    const std::vector<double> samples(frames.samples.begin(), frames.samples.end());
    // Rounding by 1/64 e in 28 samples, 7 ns off on average: 3 e ns of 50 or 5000 e at worst.
    time_s[dark] = moments_of(lidar, samples).time_s;
  }
  EXPECT_NEAR(time_s[0], 20 / c, 6e-13);
  EXPECT_NEAR(time_s[1] - time_s[0], 0.4e-9, 6e-11);
}

// Seen in a mirror of silver, by transported light alone: by the law at the energy that arrives.
// Rounding by half a step in each of 28 samples, 7 ns off on average, of 2e5 steps: 5e-13 s at
// worst; twice that for two.
TEST(RangeWalk, DelaysLightThatComesOverAMirror) {
  PulsedLidar lidar = small_lidar();
  lidar.pattern = RasterPattern{.rows = 1, .columns = 1, .height_rad = 0, .width_rad = 0};
  lidar.ambient_electrons = 0;
  lidar.electrons_at_10m = 1e6;
  const auto seen_s = [&](double albedo, double per_decade_s) {
    lidar.range_walk = {.per_decade_s = per_decade_s, .at_electrons = 5000};
    lidar.sensor = {.gain_e_per_dn = 4 * albedo, .full_well_e = 1e9, .bits = 16};
    Scene scene = scene_of(plane_at(4, std::numbers::pi / 4), albedo);
    scene.materials.push_back(
        {.name = "mirror", .bsdf = Conductor{.eta = 0.15, .k = 5.7, .roughness = 0}});
    scene.objects[0].material = 1;
    const Eigen::AngleAxisd turn(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
    scene.objects.push_back(plane_at(0));
    scene.objects[1].world_from_object = make_pose(turn.toRotationMatrix(), {-6, 0, 0});
    const Waveforms frames =
        frames_of(lidar, scene, EffectSet(with_walk).set(Effect::mirror_reflection));
    return moments_of(lidar, {frames.samples.begin(), frames.samples.end()});
  };
  for (const double albedo : {1.0, 0.01}) {
    const Moments plain = seen_s(albedo, 0), late = seen_s(albedo, -0.2e-9);
    ASSERT_GT(plain.electrons, 1000);
    // 4 m to the mirror and 6 m on
    EXPECT_NEAR(plain.time_s, 20 / c, 1e-10);
    EXPECT_NEAR(late.time_s - plain.time_s,
                -0.2e-9 * std::log10(4 * albedo * plain.electrons / 5000), 1e-12)
        << albedo;
  }
}

TEST(RangeWalk, IsInTheCalibrationIfKnownAndNowhereIfOff) {
  PulsedLidar lidar = small_lidar();
  lidar.range_walk = {.per_decade_s = -0.2e-9, .at_electrons = 300, .is_calibrated = true};
  const Scene scene = scene_of(plane_at(10), 1);
  const Waveforms known = frames_of(lidar, scene, with_walk);
  EXPECT_EQ(known.calibration.range_walk_s, -0.2e-9);
  EXPECT_EQ(known.calibration.range_walk_electrons, 300);
  const Waveforms off = frames_of(lidar, scene, with_walk.without(Effect::range_walk));
  EXPECT_EQ(off.calibration.range_walk_s, 0);
  lidar.range_walk = {};
  EXPECT_EQ(off.samples, frames_of(lidar, scene, with_walk).samples);
  EXPECT_NE(off.samples, known.samples);
}

// The gate is a piece of the whole window's record, a quarter of it before the first reading of 50
// electrons above ambient light; rays into nothing keep the window's start.
TEST(LidarGate, KeepsWhatTheWindowHolds) {
  PulsedLidar lidar = small_lidar();
  lidar.sensor = {.gain_e_per_dn = 2, .offset_dn = 20, .read_noise_e = 3};
  const Scene scene = scene_of(sphere_at({0, 0, 15}, 2), 0.8);
  const Waveforms whole = frames_of(lidar, scene, sensor_effects);
  lidar.gate = {.samples = 40, .threshold_electrons = 50};
  const Waveforms gated = frames_of(lidar, scene, sensor_effects);
  ASSERT_EQ(gated.samples_per_ray, 40u);
  ASSERT_EQ(gated.first_sample.size(), 48u);
  int triggered = 0;
  for (std::size_t ray = 0; ray < 48; ++ray) {
    const auto* record = &whole.samples[ray * whole.samples_per_ray];
    std::uint32_t trigger = 0;
    while (trigger < whole.samples_per_ray && record[trigger] < 20 + 55 / 2.0) ++trigger;
    const bool any = trigger < whole.samples_per_ray;
    triggered += any;
    EXPECT_EQ(gated.first_sample[ray], any ? trigger - 10 : 0) << ray;
    for (int i = 0; i < 40; ++i)
      EXPECT_EQ(gated.samples[ray * 40 + i], record[gated.first_sample[ray] + i]);
  }
  EXPECT_GT(triggered, 8);
  EXPECT_LT(triggered, 40);
}

TEST(LidarGate, NamesTheFieldThatIsWrong) {
  PulsedLidar lidar = small_lidar();
  lidar.gate.samples = 8;
  EXPECT_NE(complaint(lidar).find("pulsed_lidar/gate.samples: 8, must be from 16"),
            std::string::npos);
  lidar.gate = {.samples = 32, .threshold_electrons = 0};
  EXPECT_EQ(complaint(lidar),
            "pulsed_lidar/gate.threshold_electrons: 0, must be positive and finite");
  lidar = small_lidar();
  lidar.range_walk.at_electrons = 0;
  EXPECT_EQ(complaint(lidar),
            "pulsed_lidar/range_walk.at_electrons: 0, must be positive and finite");
}

}  // namespace
}  // namespace scan::synth
