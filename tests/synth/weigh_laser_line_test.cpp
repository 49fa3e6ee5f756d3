// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "synth/effects/weight.h"
#include "tests/synth/laser_bench.h"

namespace scan::synth {
namespace {

LaserLine device() {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-3;
  s.steps = 5;
  s.step_m = 2e-3;
  s.sensor = {.gain_e_per_dn = 4, .read_noise_e = 10, .bits = 12};
  return s;
}

TEST(LaserPilot, SeesAWhitePlane) {
  const LaserLine s = device();
  const double z = focus_z(s);
  const Scene scene = white_scene({plane_at(z)});
  const auto rays = pilot(s, RayCaster(scene), Pose::Identity(), 1000);
  ASSERT_GT(rays.size(), 400u);
  for (const PilotRay& ray : rays) {
    // the plane's points on the fan: x = 0, so range = z / cos of the view's angle
    EXPECT_NEAR(ray.range_m, z / std::cos(ray.incidence_rad), 1e-12);
    EXPECT_LE(ray.signal_e, s.peak_electrons * (1 + 1e-9));
    EXPECT_GT(ray.signal_e, 0.7 * s.peak_electrons);
    // a plane lights itself not
    EXPECT_EQ(ray.indirect_share, 0);
    EXPECT_FALSE(ray.met_smooth);
  }
  // sigma at the middle: width 1e-3 / 2 / cos(theta) f / z px, dz/du = z^2 / (b f)
  const double width = std::hypot(1e-3 / 2 / std::cos(theta) * 300 / z, std::sqrt(1.0 / 12));
  const double shot = std::sqrt(width / (std::sqrt(2 * std::numbers::pi) * s.peak_electrons));
  const double white = std::sqrt(2 * width / std::sqrt(std::numbers::pi)) / s.peak_electrons *
                       std::hypot(10, 4 / std::sqrt(12.0));
  const auto middle = *std::min_element(
      rays.begin(), rays.end(),
      [](const PilotRay& a, const PilotRay& b) { return a.incidence_rad < b.incidence_rad; });
  // the middle ray is off the axis by less than a step of the fan, 1e-2 rad: 1e-4 of all
  EXPECT_NEAR(middle.sigma_m, std::hypot(shot, white) * z * z / (s.baseline_m * 300),
              1e-3 * middle.sigma_m);
}

TEST(LaserWeights, AreAbsentForAnIdealDevice) {
  const LaserLine s = device();
  const Scene scene = white_scene({plane_at(0.2)});
  const auto rays = pilot(s, RayCaster(scene), Pose::Identity(), 500);
  for (const Effect effect : all_effects()) {
    const Weighed weighed = weigh(s, scene, effect, rays);
    const bool is_there = effect == Effect::shot_noise || effect == Effect::read_noise ||
                          effect == Effect::quantisation || effect == Effect::interreflection;
    EXPECT_EQ(weighed.weight.has_value(), is_there) << name(effect);
    EXPECT_EQ(weighed.why_absent.empty(), is_there) << name(effect);
  }
  EXPECT_EQ(weigh(s, scene, Effect::interreflection, rays).weight->bound_m, 0);
}

// Three sigma of shot noise, times what least squares lose, over the sigma of all noises.
TEST(LaserWeights, AreSharesOfTheScannersSigma) {
  LaserLine s = device();
  s.plane_bow_m = 1e-4;
  const Scene scene = white_scene({plane_at(0.2)});
  const auto rays = pilot(s, RayCaster(scene), Pose::Identity(), 500);
  const auto weight = [&](Effect effect) { return *weigh(s, scene, effect, rays).weight; };
  EXPECT_GT(weight(Effect::shot_noise).bound_sigma, 2.5);
  EXPECT_LE(weight(Effect::shot_noise).bound_sigma, 3 * 1.2411);
  EXPECT_LT(weight(Effect::read_noise).bound_sigma, 3 * 1.5941);
  EXPECT_GT(weight(Effect::plane_bow).bound_sigma, 3);
  EXPECT_NE(weight(Effect::plane_bow).why.find("plane bow"), std::string::npos);
}

TEST(LaserWeights, KnowMirrorsAndWallsThatShine) {
  const LaserLine s = device();
  Scene corner = white_scene({plane_at(0.2, 0.7), plane_at(0.2, -0.7)});
  const auto rays = pilot(s, RayCaster(corner), Pose::Identity(), 500);
  EXPECT_GT(weigh(s, corner, Effect::interreflection, rays).weight->bound_sigma, 1);
  corner.materials.push_back({.name = "mirror", .bsdf = Conductor{.roughness = 0}});
  corner.objects[1].material = 1;
  const auto mirrored = pilot(s, RayCaster(corner), Pose::Identity(), 500);
  ASSERT_FALSE(mirrored.empty());
  EXPECT_GT(weigh(s, corner, Effect::mirror_reflection, mirrored).weight->bound_m, 0.1);
}

}  // namespace
}  // namespace scan::synth
