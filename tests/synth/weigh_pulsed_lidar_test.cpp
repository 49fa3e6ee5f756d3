// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The bounds that the planner goes by hold, and not by far, on scenes built to meet them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/acquire/acquire.h"
#include "synth/effects/weight.h"
#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

// Fine steps instead of noise, so that only the effect is seen.
PulsedLidar device() {
  PulsedLidar lidar;
  lidar.pattern = RasterPattern{.rows = 10, .columns = 12, .height_rad = 0.2, .width_rad = 0.25};
  lidar.electrons_at_10m = 20000;
  lidar.ambient_electrons = 2;
  lidar.max_range_m = 40;
  lidar.sensor = {.gain_e_per_dn = 0.25, .offset_dn = 40, .read_noise_e = 4, .bits = 16};
  return lidar;
}

// Largest difference of the decoded ranges, with the effects and without one of them.
double measured_m(const PulsedLidar& lidar, const Scene& scene, Effect effect,
                  const EffectSet& effects) {
  const RayCaster with(simplified(scene, effects));
  const RayCaster without(simplified(scene, effects.without(effect)));
  const auto decode = [&](const RayCaster& caster, const EffectSet& on) {
    const Scan scan = acquire(render(lidar, caster, Pose::Identity(), {}, on).frames);
    std::vector<double> range_m(120, std::nan(""));
    for (std::size_t i = 0; i < scan.cloud.size(); ++i)
      range_m[scan.ray[i]] = scan.cloud.points[i].norm();
    return range_m;
  };
  const auto a = decode(with, effects), b = decode(without, effects.without(effect));
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i]))
      largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

Weighed weighed(const PulsedLidar& lidar, const Scene& scene, Effect effect) {
  const RayCaster caster(scene);
  return weigh(lidar, scene, effect, pilot(lidar, caster, Pose::Identity(), 2000));
}

// Within the bound, and the bound not ten times too large. Rounding and the sampled pulse's shape
// move ranges by 1e-4 m (lidar_range_test.cpp).
void expect_bound(const PulsedLidar& lidar, const Scene& scene, Effect effect) {
  const Weighed weight = weighed(lidar, scene, effect);
  ASSERT_TRUE(weight.weight) << weight.why_absent;
  EXPECT_FALSE(weight.weight->why.empty());
  const double error_m = measured_m(lidar, scene, effect, EffectSet{effect});
  EXPECT_LE(error_m, weight.weight->bound_m + 1e-4);
  EXPECT_GE(error_m, weight.weight->bound_m / 10 - 1e-4);
  EXPECT_GT(error_m, 1e-3);
}

TEST(WeighPulsedLidar, BoundsAMixedFootprint) {
  PulsedLidar lidar = device();
  lidar.divergence_rad = 5e-3;
  lidar.sub_rays = 5;
  for (const double behind_m : {0.1, 3.0}) {
    const Scene scene{.objects = {plane_at(12 + behind_m), plate(12, 0.13, 3)},
                      .materials = {plain(0.5)}};
    expect_bound(lidar, scene, Effect::footprint);
  }
}

TEST(WeighPulsedLidar, BoundsMotion) {
  PulsedLidar lidar = device();
  lidar.motion = {.interval_s = 1e-4,
                  .velocity_m_s = {1, 0, 10},
                  .angular_velocity_rad_s = {0, 0.5, 0},
                  .is_measured = true};
  expect_bound(lidar, scene_of(plane_at(12, 0.3), 0.5), Effect::motion);
}

TEST(WeighPulsedLidar, BoundsTheRangeWalk) {
  PulsedLidar lidar = device();
  lidar.range_walk = {.per_decade_s = -0.2e-9, .at_electrons = 1000};
  expect_bound(lidar, scene_of(plane_at(12, 0.3), 0.05), Effect::range_walk);
}

// The fog's light on the near side of a dark wall's echo; under so much ambient light that the fog
// itself is no echo, and so strong a pulse that noise does not hide what it pulls.
TEST(WeighPulsedLidar, BoundsFog) {
  PulsedLidar lidar = device();
  lidar.overlap_m = 9;
  lidar.electrons_at_10m = 2e6;
  lidar.ambient_electrons = 2e4;
  lidar.sensor.gain_e_per_dn = 1;
  Scene scene = scene_of(plane_at(12), 0.02);
  scene.medium = fog(3000, 0, 1);
  expect_bound(lidar, scene, Effect::medium);
}

// A wide beam in a small sphere: light that comes over two and more places of it is late.
TEST(WeighPulsedLidar, BoundsInterreflection) {
  PulsedLidar lidar = device();
  lidar.divergence_rad = 0.3;
  lidar.sub_rays = 2;
  lidar.electrons_at_10m = 10;
  lidar.ambient_electrons = 0;
  lidar.sensor.read_noise_e = 0;  // so that the echo's tail weighs as much as its middle
  lidar.min_range_m = 0.3;
  const Scene scene = scene_of(sphere_at({0, 0, 0}, 0.6), 0.8);
  const Weighed weight = weighed(lidar, scene, Effect::interreflection);
  ASSERT_TRUE(weight.weight);
  const double error_m = measured_m(lidar, scene, Effect::interreflection,
                                    {Effect::interreflection, Effect::footprint});
  EXPECT_LE(error_m, weight.weight->bound_m);
  EXPECT_GE(error_m, weight.weight->bound_m / 10);
}

// Noise has no bound; three of its sigma by the closed form, against the spread of decoded ranges.
TEST(WeighPulsedLidar, KnowsTheNoise) {
  PulsedLidar lidar = device();
  const Scene scene = scene_of(sphere_at({0, 0, 0}, 12), 0.1);
  for (const Effect effect : {Effect::shot_noise, Effect::read_noise}) {
    const Scan scan =
        acquire(render(lidar, RayCaster(scene), Pose::Identity(), {}, {effect}).frames);
    ASSERT_EQ(scan.cloud.size(), 120u);
    double square = 0;
    for (const Eigen::Vector3d& point : scan.cloud.points)
      square += std::pow(point.norm() - 12, 2) / 120;
    const double sigma_m = weighed(lidar, scene, effect).weight->bound_m / 3;
    // 120 ranges: 5 sqrt(1 / 240); the fit weighs for shot noise, 5 % off for white noise alone
    EXPECT_NEAR(std::sqrt(square) / sigma_m, 1, 5 / std::sqrt(240.0) + 0.05) << name(effect);
  }
}

// Behind a pane stands what is measured.
TEST(WeighPulsedLidar, LooksThroughClearBodies) {
  Scene scene = scene_of(plane_at(12), 0.5);
  const auto bare = pilot(device(), RayCaster(scene), Pose::Identity(), 50);
  scene.materials.push_back({.name = "glass", .bsdf = Dielectric{1.5}});
  scene.objects.push_back({.name = "pane",
                           .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {0, 0, 6}),
                           .geometry = Shape(BoxShape{{9, 9, 0.01}}),
                           .material = 1});
  const auto behind = pilot(device(), RayCaster(scene), Pose::Identity(), 50);
  ASSERT_EQ(bare.size(), behind.size());
  for (std::size_t i = 0; i < bare.size(); ++i) {
    EXPECT_EQ(bare[i].range_m, behind[i].range_m);
    EXPECT_EQ(bare[i].sigma_m, behind[i].sigma_m);
    EXPECT_FALSE(bare[i].met_smooth);
    EXPECT_TRUE(behind[i].met_smooth);
  }
}

TEST(WeighPulsedLidar, SaysWhatIsNotThere) {
  const PulsedLidar lidar = device();
  const Scene scene = scene_of(plane_at(12), 0.5);
  for (const Effect effect : all_effects()) {
    const Weighed weight = weighed(lidar, scene, effect);
    EXPECT_NE(weight.weight.has_value(), !weight.why_absent.empty()) << name(effect);
  }
  EXPECT_EQ(weighed(lidar, scene, Effect::footprint).why_absent, "the beam is a line");
  EXPECT_EQ(weighed(lidar, scene, Effect::medium).why_absent, "the air is clear");
  Scene mirror = scene;
  mirror.materials[0].bsdf = Conductor{.roughness = 0};
  EXPECT_EQ(weighed(lidar, mirror, Effect::mirror_reflection).weight->bound_m, 40);
}

}  // namespace
}  // namespace scan::synth
