// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The scene's own lights: white furnaces, and multiple importance sampling against a plain tracer.
#include <gtest/gtest.h>

#include "tests/synth/light_paths.h"
#include "tests/synth/plain_tracer.h"
#include "tests/synth/ray_scenes.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

constexpr double pi = std::numbers::pi;

Material made_of(const Bsdf& bsdf) {
  return {.name = "", .bsdf = bsdf, .texture = {}, .interior = {}};
}

Mean other_light(const Scene& scene, const Ray& view, int samples,
                 const TransportOptions& options = {}) {
  const RayCaster caster(scene);
  const LightTransport transport(caster, options);
  const PointEmitter dark{.place = {0, 0, -100}, .intensity = 0};
  return means_of(
      samples, {},
      [&](SampleSequence& random, Tally& tally) {
        trace_path(transport, view, dark, random, tally);
      },
      [](const Tally& tally, int count) { return std::vector<double>{tally.other / count}; })[0];
}

// Light of one radiance L from all sides: a convex body returns L times its albedo for the
// direction that it is seen from, whichever way the light is sampled.
TEST(WhiteFurnace, ConvexBodyReturnsItsAlbedo) {
  const std::vector<Bsdf> kinds = {
      Lambert{1},
      Lambert{0.3},
      OrenNayar{0.9, 0.4},
      Conductor{.eta = 1.4, .k = 7, .roughness = 0.3},
      Conductor{.eta = 1.4, .k = 7, .roughness = 0.05, .facets = Microfacets::beckmann},
      Plastic{.albedo = 0.8, .index = 1.5, .roughness = 0.2},
      Plastic{.albedo = 0.8, .index = 1.5, .roughness = 0}};
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d(0.05, 0, 1).normalized()};
  const Eigen::Vector3d centre(0, 0, 5);
  const double distance_m = distance_to_sphere(view.direction, centre, 0.5);
  const Eigen::Vector3d normal = (distance_m * view.direction - centre) / 0.5;
  const double cosine = -view.direction.dot(normal);
  const Eigen::Vector3d out(std::sqrt(1 - cosine * cosine), 0, cosine);
  for (const Bsdf& kind : kinds) {
    Scene scene;
    scene.materials = {made_of(kind)};
    scene.objects = {sphere_at(centre, 0.5)};
    scene.lights = {Environment{.radiance_w_m2_sr = 2}};
    SCOPED_TRACE(kind.index());
    const Mean mean = other_light(scene, view, 2048);
    const double truth = 2 * pi * albedo(kind, out);
    EXPECT_LT(sure * mean.error, 0.01 * truth);
    // albedo() reads metals and plastics from a table, whose error is below 5e-4 (bsdf_test)
    EXPECT_NEAR(mean.value, truth, sure * mean.error + 5e-4 * truth);
  }
}

// A corner of white walls and a concave white shell lose nothing either: what leaves them comes
// from the environment in the end. Paths of more than 64 scatterings carry less than 1e-3.
TEST(WhiteFurnace, WhiteCornerVanishes) {
  Scene scene;
  scene.materials = {plain(1)};
  scene.objects = {plate(1, -1, 1), plate(1, -1, 1)};
  scene.objects[0].world_from_object =
      at(0, 0.5, 0) * Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitX());
  scene.lights = {Environment{.radiance_w_m2_sr = 1}};
  const Ray view{{0, 0, -3}, Eigen::Vector3d(0.02, 0.01, 1).normalized()};
  expect_mean(other_light(scene, view, 1024, {.most_scatterings = 64}), pi, 0.02, "electrons");
}

// A clear ball bends the rays and changes nothing; every path that leaves it within the limit of
// smooth surfaces brings pi L.
TEST(WhiteFurnace, ClearBallVanishes) {
  for (const double index : {1.0, 1.33, 1.5, 2.4}) {
    Scene scene;
    scene.materials = {made_of(Dielectric{.index = index})};
    scene.objects = {sphere_at({0, 0, 5}, 0.5)};
    scene.lights = {Environment{.radiance_w_m2_sr = 1}};
    const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d(0.05, 0.03, 1).normalized()};
    const Mean mean = other_light(scene, view, 256, {.most_smooth = 64});
    EXPECT_NEAR(mean.value, pi, 1e-12);
  }
}

// A white wall behind a pane: from the wall the environment is met through the glass only, where
// next-event estimation does not look.
TEST(WhiteFurnace, WhiteWallBehindAPaneVanishes) {
  Scene scene;
  scene.materials = {plain(1), made_of(Dielectric{.index = 1.5})};
  scene.objects = {plane_at(2), plane_at(1.9, 0, 1)};
  scene.objects[1].geometry = Shape(BoxShape{{1000, 1000, 0.01}});
  scene.lights = {Environment{.radiance_w_m2_sr = 1}};
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d(0.02, 0.01, 1).normalized()};
  const Mean mean = other_light(scene, view, 256, {.most_scatterings = 400, .most_smooth = 64});
  // every path brings pi L, but for the one in a million that is lost at the pane's far rim
  EXPECT_NEAR(mean.value, pi, 1e-3 * pi);
}

Scene glossy_room(double roughness) {
  Scene scene;
  scene.materials = {plain(0.7), made_of(Conductor{.eta = 0.2, .k = 3, .roughness = roughness})};
  scene.objects = {plane_at(2), sphere_at({0.3, 0, 1.6}, 0.3, 1)};
  const Eigen::AngleAxisd turn(0.6, Eigen::Vector3d::UnitY());
  scene.lights = {AreaLight{.world_from_light = at(-1, 0.1, 0.8) * turn,
                            .width_m = 0.8,
                            .height_m = 0.6,
                            .radiance_w_m2_sr = 10},
                  Environment{.radiance_w_m2_sr = 0.3}};
  return scene;
}

Mean plainly_traced(const Scene& scene, const Ray& view, int samples, int most) {
  const RayCaster caster(scene);
  const PlainTracer tracer(caster, most);
  return means_of(
      samples, {},
      [&](SampleSequence& random, Tally& tally) { tally.other += tracer.path(view, random); },
      [](const Tally& tally, int count) { return std::vector<double>{tally.other / count}; }, 1)[0];
}

// Next-event estimation with BSDF sampling against BSDF sampling alone: equal means, and the
// variance of glossy and of matt points falls.
TEST(MultipleImportanceSampling, AgreesWithBsdfSamplingAlone) {
  for (const double roughness : {0.02, 0.3}) {
    const Scene scene = glossy_room(roughness);
    for (const Eigen::Vector3d& place :
         {Eigen::Vector3d(0.22, 0.02, 1.4), Eigen::Vector3d(-0.2, 0, 2)}) {
      const Ray view{Eigen::Vector3d::Zero(), place.normalized()};
      const Mean both = other_light(scene, view, 4096, {.most_scatterings = 3});
      const Mean alone = plainly_traced(scene, view, 4096, 3);
      expect_same(both, alone, 0.05, "electrons");
      EXPECT_LT(both.error, alone.error);
    }
  }
}

// A ball of ground glass before the area light: light goes through its surface both ways.
TEST(MultipleImportanceSampling, AgreesWithBsdfSamplingAloneThroughGroundGlass) {
  Scene scene = glossy_room(0.1);
  scene.materials[1] = made_of(Dielectric{.index = 1.4, .roughness = 0.3});
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d(0.22, 0.02, 1.4).normalized()};
  const Mean both = other_light(scene, view, 8192, {.most_scatterings = 4});
  const Mean alone = plainly_traced(scene, view, 8192, 4);
  expect_same(both, alone, 0.05, "electrons");
}

}  // namespace
}  // namespace scan::synth
