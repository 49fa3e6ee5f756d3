// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "libscan/core/error.h"
#include "synth/effects/thin.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

LaserLine laser() {
  return {.camera = {160, 120, 400, 400, 79.5, 59.5},
          .peak_electrons = 8000,
          .steps = 20,
          .step_m = 1e-3,
          .sensor = {.gain_e_per_dn = 4, .read_noise_e = 8, .bits = 12}};
}

StereoPair stereo() {
  StereoPair pair;
  pair.calibration = {.width_px = 160,
                      .height_px = 120,
                      .focal_px = 250,
                      .cx_px = 79.5,
                      .cy_px = 59.5,
                      .baseline_m = 0.06,
                      .disparities_px = 96};
  return pair;
}

PhaseCamera phase() {
  return {.camera = {80, 60, 85, 85, 39.5, 29.5}, .sensor = {.read_noise_e = 20}};
}

PulsedLidar lidar() {
  return {.pattern = RasterPattern{30, 40, 0.3, 0.4}, .sensor = {.read_noise_e = 10}};
}

std::vector<Scanner> every_scanner() {
  return {laser(), stereo(), phase(), lidar()};
}

// A ball where the scanner sees it well, with a print for the stereo pair.
Scene ball(const Scanner& scanner) {
  const double z_m = std::holds_alternative<PulsedLidar>(scanner)   ? 8
                     : std::holds_alternative<PhaseCamera>(scanner) ? 1.3
                     : std::holds_alternative<StereoPair>(scanner)  ? 0.6
                                                                    : 0.19;
  return {.objects = {sphere_at({0, 0, z_m}, z_m / 5)},
          .materials = {
              {.name = "print", .bsdf = Lambert{0.8}, .texture = NoiseTexture{z_m / 15, 2, 0.8}}}};
}

EffectPlan plan_for(const Scanner& scanner, const Scene& scene, const EffectChoice& choice = {}) {
  const std::vector<Pose> views = {Pose::Identity()};
  return plan_effects(scanner, scene, views, choice);
}

const EffectDecision& named(const EffectPlan& plan, Effect effect) {
  for (const EffectDecision& decision : plan)
    if (decision.effect == effect) return decision;
  throw std::out_of_range("no decision");
}

TEST(EffectPlan, DecidesEachEffectForEachScannerWithAReason) {
  for (const Scanner& scanner : every_scanner()) {
    const EffectPlan plan = plan_for(scanner, ball(scanner));
    ASSERT_EQ(plan.size(), static_cast<std::size_t>(effect_count));
    for (const EffectDecision& decision : plan) {
      EXPECT_GE(decision.bound_m, 0) << name(decision.effect);
      EXPECT_TRUE(std::isfinite(decision.bound_m)) << name(decision.effect);
      EXPECT_TRUE(std::isfinite(decision.bound_sigma)) << name(decision.effect);
      EXPECT_EQ(decision.reason.back(), '.') << decision.reason;
      EXPECT_EQ(decision.on, decision.bound_sigma >= 0.02) << decision.reason;
    }
    EXPECT_TRUE(named(plan, Effect::shot_noise).on) << "light is never without it";
  }
}

// Convex, matt, alone in clear air: light meets it once.
TEST(EffectPlan, LeavesOutAllTransportForABall) {
  for (const Scanner& scanner : every_scanner()) {
    const EffectPlan plan = plan_for(scanner, ball(scanner));
    for (const Effect effect :
         {Effect::interreflection, Effect::mirror_reflection, Effect::refraction,
          Effect::subsurface, Effect::medium, Effect::scene_lights})
      EXPECT_FALSE(named(plan, effect).on) << named(plan, effect).reason;
  }
}

// Two walls that meet at a right angle, their edge on the axis.
Scene corner(double z_m, double albedo) {
  Scene scene{.objects = {}, .materials = {plain(albedo)}};
  for (const double side : {-1.0, 1.0}) {
    Object wall = plane_at(z_m, side * std::numbers::pi / 4);
    scene.objects.push_back(std::move(wall));
  }
  return scene;
}

TEST(EffectPlan, SwitchesInterreflectionOnInACorner) {
  EXPECT_TRUE(named(plan_for(phase(), corner(1.5, 0.8)), Effect::interreflection).on);
  EXPECT_TRUE(named(plan_for(lidar(), corner(8, 0.8)), Effect::interreflection).bound_m > 0);
}

TEST(EffectPlan, SwitchesOnWhatTheScenesMaterialsCallFor) {
  for (const Scanner& scanner : every_scanner()) {
    Scene scene = ball(scanner);
    const double z_m = scene.objects[0].world_from_object.translation().z();
    scene.objects.push_back(plane_at(2 * z_m));
    scene.objects[0].material = 1;
    scene.materials.push_back({.name = "mirror", .bsdf = Conductor{.roughness = 0}});
    EXPECT_TRUE(named(plan_for(scanner, scene), Effect::mirror_reflection).on)
        << named(plan_for(scanner, scene), Effect::mirror_reflection).reason;
    scene.materials[1].bsdf = Dielectric{};
    EXPECT_TRUE(named(plan_for(scanner, scene), Effect::refraction).on)
        << named(plan_for(scanner, scene), Effect::refraction).reason;
  }
}

TEST(EffectPlan, FollowsAnExplicitChoice) {
  using Kind = EffectChoice::Kind;
  const Scene scene = ball(laser());
  for (const auto& decision : plan_for(laser(), scene, {Kind::all, {}})) EXPECT_TRUE(decision.on);
  for (const auto& decision : plan_for(laser(), scene, {Kind::none, {}})) EXPECT_FALSE(decision.on);
  const EffectSet effects = effects_of(
      plan_for(laser(), scene, {Kind::named, {"read-noise", "quantisation", "plane_bow"}}));
  EXPECT_EQ(effects, (EffectSet{Effect::read_noise, Effect::quantisation, Effect::plane_bow}));
}

TEST(EffectPlan, NamesTheNearestKnownEffect) {
  try {
    check(EffectChoice{EffectChoice::Kind::named, {"shot nose"}});
    FAIL() << "an unknown name must be refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::usage);
    EXPECT_NE(std::string(error.what()).find("shot nose"), std::string::npos);
    EXPECT_EQ(error.hint(), "did you mean 'shot-noise'?");
  }
}

TEST(EffectPlan, IsTheSameForAnyThreadCount) {
  for (const Scanner& scanner : every_scanner()) {
    const Scene scene = ball(scanner);
    expect_same_for_any_thread_count([&] {
      std::vector<std::tuple<bool, double, double>> decisions;
      for (const EffectDecision& d : plan_for(scanner, scene))
        decisions.emplace_back(d.on, d.bound_m, d.bound_sigma);
      return decisions;
    });
  }
}

TEST(EffectName, IsFoundAgain) {
  for (const Effect effect : all_effects()) {
    std::string word(name(effect));
    EXPECT_EQ(effect_named(word), effect);
    std::replace(word.begin(), word.end(), ' ', '-');
    EXPECT_EQ(effect_named(word), effect);
  }
  EXPECT_EQ(effect_named("gloss"), std::nullopt);
}

// Fewer rays over the same view, each as exact as before.
TEST(Thinned, KeepsTheViewWithFewerRays) {
  for (const Scanner& scanner : every_scanner()) {
    const Scanner few = thinned(scanner, 300);
    check(few);
    EXPECT_LT(ray_count(few), ray_count(scanner));
    EXPECT_GE(ray_count(few), 60);
    EXPECT_EQ(ray_count(thinned(scanner, 1e9)), ray_count(scanner));
  }
  const auto camera = std::get<PhaseCamera>(thinned(phase(), 300)).camera;
  EXPECT_NEAR(camera.width_px / camera.fx_px, 80 / 85.0, 1e-12);
  EXPECT_NEAR((camera.cx_px + 0.5) / camera.fx_px, 40 / 85.0, 1e-12);
}

}  // namespace
}  // namespace scan::synth
