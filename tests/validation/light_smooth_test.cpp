// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light over mirrors and through glass against closed forms.
#include <gtest/gtest.h>

#include <map>

#include "synth/bsdf/fresnel.h"
#include "tests/synth/light_paths.h"
#include "tests/synth/ray_scenes.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

Material made_of(const Bsdf& bsdf) {
  return {.name = "", .bsdf = bsdf, .texture = {}, .interior = {}};
}

// Electrons by optical path, to the nanometre: arrivals over smooth surfaces come in single
// lengths.
struct Lengths {
  std::map<long, double> electrons;
  void device_light(double e, double path_m, int) { electrons[std::lround(path_m * 1e9)] += e; }
  void other_light(double) {}
};

std::map<long, double> arrivals(const Scene& scene, const Ray& view, const PointEmitter& emitter,
                                const TransportOptions& options, int samples) {
  const RayCaster caster(scene);
  const LightTransport transport(caster, options);
  Lengths lengths;
  SampleSequence random(1, 0, 0, 0);
  for (int i = 0; i < samples; ++i) {
    random.start(i);
    trace_path(transport, view, emitter, random, lengths);
  }
  for (auto& [length, electrons] : lengths.electrons) electrons /= samples;
  return lengths.electrons;
}

// The lens looks into a mirror, a thin plate in z = 2, and sees a wall beside itself, x = -1.
struct Ghost {
  Conductor silver{.eta = 0.05, .k = 4, .roughness = 0};
  Eigen::Vector3d lens = {0.5, 0, 0}, bend = {0, 0, 2}, seen = {-1, 0, -2}, image = {0.5, 0, 4};
  PointEmitter emitter{.place = lens, .intensity = 10};
  Ray view{lens, (bend - lens).normalized()};

  Scene scene() const {
    Scene scene;
    scene.materials = {plain(0.5), made_of(silver)};
    const Eigen::AngleAxisd turn(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
    scene.objects = {plate(2, -0.5, 0.5, 1),
                     {.name = "wall",
                      .world_from_object = make_pose(turn.toRotationMatrix(), {-1, 0, 0}),
                      .geometry = Shape(PlaneShape{}),
                      .material = 0}};
    return scene;
  }
  double lit_from(const Eigen::Vector3d& light) const {
    return 0.5 * 10 * (light.x() + 1) / std::pow((light - seen).norm(), 3);
  }
};

// The wall's ghost is lit by the device itself and, as if from the device's own mirror image, over
// the mirror.
TEST(Mirror, ShowsAGhostAtTheMirroredPlace) {
  const Ghost ghost;
  const double way_m = (ghost.image - ghost.seen).norm();
  ASSERT_NEAR(way_m, (ghost.bend - ghost.lens).norm() + (ghost.seen - ghost.bend).norm(), 1e-12);
  const double reflectance =
      fresnel_conductor(ghost.view.direction.z(), ghost.silver.eta, ghost.silver.k);
  const auto all = arrivals(ghost.scene(), ghost.view, ghost.emitter, {.most_scatterings = 1}, 4);
  ASSERT_EQ(all.size(), 2u);
  const long once = std::lround((way_m + (ghost.seen - ghost.lens).norm()) * 1e9);
  const long twice = std::lround(2 * way_m * 1e9);
  EXPECT_NEAR(all.at(once), reflectance * ghost.lit_from(ghost.lens), 1e-10);
  EXPECT_NEAR(all.at(twice), reflectance * reflectance * ghost.lit_from(ghost.image), 1e-10);
}

// Without the effect the light ends at the mirror, with panes or without ...
TEST(Mirror, IsBlackWithoutTheEffect) {
  const Ghost ghost;
  const auto with = [&](const EffectSet& effects) {
    return arrivals(ghost.scene(), ghost.view, ghost.emitter, transport_options(effects, false), 4);
  };
  EXPECT_TRUE(with({Effect::refraction}).empty());
  EXPECT_TRUE(with({}).empty());
  EXPECT_EQ(with({Effect::mirror_reflection}).size(), 2u);
}

// ... and a wall that sees the light in a mirror gets it straight only.
TEST(Mirror, LightsNothingWithoutTheEffect) {
  Scene scene;
  scene.materials = {plain(0.5), made_of(Conductor{.eta = 0.05, .k = 4, .roughness = 0})};
  scene.objects = {plane_at(3), plate(-0.5, -2, 2, 1)};
  const PointEmitter emitter{.place = {0.5, 0, 0}};
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  const TransportOptions panes = transport_options({Effect::refraction}, false);
  EXPECT_EQ(arrivals(scene, view, emitter, panes, 1).size(), 1u);
  const TransportOptions mirrors = transport_options({Effect::mirror_reflection}, false);
  EXPECT_EQ(arrivals(scene, view, emitter, mirrors, 1).size(), 2u);
}

// A pane between a coaxial device and a wall. Straight through, the light passes each of four
// surfaces with 1 - r and is late by d (n - 1) each way. Each double inner reflection takes r^2 and
// adds 2 d n; on the way out or on the way back alike.
TEST(Pane, DelaysLightByThicknessTimesIndexMinusOne) {
  const double index = 1.5, thickness_m = 0.004, r = 0.04;
  const int samples = 1024;
  Scene scene;
  scene.materials = {plain(0.5), made_of(Dielectric{.index = index})};
  scene.objects = {plane_at(2),
                   {.name = "pane",
                    .world_from_object = at(0, 0, 1),
                    .geometry = Shape(BoxShape{{1, 1, thickness_m}}),
                    .material = 1}};
  const PointEmitter emitter{.place = Eigen::Vector3d::Zero(), .intensity = 10};
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  const auto all = arrivals(scene, view, emitter, {.most_scatterings = 1}, samples);
  const double late_m = thickness_m * (index - 1);
  const long straight = std::lround((4 + 2 * late_m) * 1e9);
  const long inner = std::lround((4 + 2 * late_m + 2 * thickness_m * index) * 1e9);
  // A flat pane shows the light nearer by d (1 - 1 / n): the irradiance is that of the distance
  // 2 - d (1 - 1 / n), and 2 - d (1 - 3 / n) with an inner reflection.
  const auto lit = [&](double inner_reflections) {
    const double distance_m = 2 - thickness_m * (1 - (1 + 2 * inner_reflections) / index);
    return 0.5 * 10 / (distance_m * distance_m) * (1 - r) * (1 - r) *
           std::pow(r * r, inner_reflections);
  };
  const double through = (1 - r) * (1 - r);
  // the view is split at each surface, Connector solves to 1e-10 of the length
  EXPECT_NEAR(all.at(straight), through * lit(0), 1e-9);
  // r^2 of both ways; the last step of the way out, which r^2 (1 - r) of the view takes, is drawn
  EXPECT_NEAR(all.at(inner), through * (lit(1) + r * r * lit(0)),
              5 * lit(0) * r * r * (1 - r) * std::sqrt(r * (1 - r) / samples));
}

// All inner reflections together let (1 - r) / (1 + r) = 0.9231 through, so the wall behind a thin
// pane keeps 0.8521 of its brightness. Of the way back Connector knows the first double reflection,
// (1 - r)^2 (1 + r^2), each seen as if from d (1 - 1 / n) or d (1 - 3 / n) nearer.
// The pane does not stand half-way: there a micrometre of the wall is lit by way of the pane's rim,
// too.
TEST(Pane, TransmitsOneMinusROverOnePlusR) {
  Scene scene;
  scene.materials = {plain(1), made_of(Dielectric{.index = 1.5})};
  const double thickness_m = 1e-6, r = 0.04;
  scene.objects = {plane_at(2),
                   {.name = "pane",
                    .world_from_object = at(0, 0, 0.9),
                    .geometry = Shape(BoxShape{{1, 1, thickness_m}}),
                    .material = 1}};
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 1});
  const PointEmitter emitter{.place = Eigen::Vector3d::Zero(), .intensity = 4};
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  const auto means = means_of(
      4096, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, emitter, random, tally);
      },
      [](const Tally& tally, int count) { return std::vector<double>{tally.device / count}; });
  const auto lit = [&](double inner_reflections) {
    return std::pow(1 - thickness_m * (1 - (1 + 2 * inner_reflections) / 1.5) / 2, -2);
  };
  const double back = (1 - r) * (1 - r) * (lit(0) + r * r * lit(1));
  // narrower than r^4 = 2.6e-6, the next double reflection on the way out
  expect_mean(means[0], (1 - r) / (1 + r) * back, 1.5e-6, "electrons");
}

// A matt floor under a block of glass: radiance is n^2 times larger in glass, so of the irradiance
// E that comes in, T(view) albedo T(light) E cos / n^2 is seen by one scattering, and with the
// light that the glass throws back (its mean inner reflectance F), over 1 - albedo F.
TEST(Glass, KeepsBasicRadiance) {
  const double index = 1.5, albedo = 0.8;
  Scene scene;
  scene.materials = {made_of(Dielectric{.index = index}), plain(albedo)};
  scene.objects = {plane_at(1), plane_at(1.001)};
  scene.objects[1].material = 1;
  const RayCaster caster(scene);
  // from 1e6 m away the light is parallel
  const double mu0 = 0.6, far = 1e6;
  const PointEmitter sun{.place = Eigen::Vector3d(far * 0.8, 0, 1 - far * mu0),
                         .intensity = far * far};
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  const LightTransport transport(caster, {.most_scatterings = 200});
  const auto means = means_of(
      2048, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, sun, random, tally);
      },
      [](const Tally& tally, int count) {
        return std::vector<double>{tally.electrons[1] / count, tally.device / count};
      });
  const double once = 0.96 * albedo * (1 - fresnel_dielectric(mu0, index)) * mu0 / (index * index);
  const double inner = fresnel_dielectric_mean(1 / index);
  expect_mean(means[0], once, 0.01, "one scattering");
  expect_mean(means[1], once / (1 - albedo * inner), 0.02, "all scatterings");
}

}  // namespace
}  // namespace scan::synth
