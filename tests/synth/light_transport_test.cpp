// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/transport/light_transport.h"

#include <gtest/gtest.h>

#include "tests/synth/light_paths.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

TEST(TransportOptions, LeaveOutWhatEffectsLeaveOut) {
  const TransportOptions none = transport_options({}, true);
  EXPECT_EQ(none.most_scatterings, 1);
  EXPECT_EQ(none.most_smooth, 0);
  EXPECT_FALSE(none.mirrors);
  EXPECT_FALSE(none.sample_emission);
  EXPECT_EQ(transport_options({Effect::interreflection}, false).most_scatterings,
            TransportOptions().most_scatterings);
  EXPECT_TRUE(transport_options({Effect::interreflection}, true).sample_emission);
  EXPECT_TRUE(transport_options({Effect::subsurface}, true).sample_emission);
  EXPECT_FALSE(transport_options({Effect::interreflection}, false).sample_emission);
  const TransportOptions mirrors = transport_options({Effect::mirror_reflection}, false);
  EXPECT_EQ(mirrors.most_smooth, TransportOptions().most_smooth);
  EXPECT_TRUE(mirrors.mirrors);
  const TransportOptions panes = transport_options({Effect::refraction}, false);
  EXPECT_EQ(panes.most_smooth, TransportOptions().most_smooth);
  EXPECT_FALSE(panes.mirrors);
  EXPECT_EQ(transport_options({Effect::subsurface}, false).most_smooth,
            TransportOptions().most_smooth);
}

struct Arrival {
  double electrons, path_m;
  int scatterings;
};
struct Arrivals {
  std::vector<Arrival> all;
  double other = 0;
  void device_light(double electrons, double path_m, int scatterings) {
    all.push_back({electrons, path_m, scatterings});
  }
  void other_light(double electrons) { other += electrons; }
};

Arrivals one_path(const Scene& scene, const Ray& view, const PointEmitter& emitter,
                  const TransportOptions& options) {
  const RayCaster caster(scene);
  const LightTransport transport(caster, options);
  SampleSequence random(1, 0, 0, 0);
  random.start(0);
  Arrivals arrivals;
  trace_path(transport, view, emitter, random, arrivals);
  return arrivals;
}

Scene wall_at(double z_m) {
  Scene scene;
  scene.materials = {plain(0.5)};
  scene.objects = {plane_at(z_m)};
  return scene;
}

// A white Lambert surface under irradiance E gives E electrons; of albedo 1/2, half.
TEST(LightTransport, DirectLightIsAlbedoTimesIrradiance) {
  const PointEmitter emitter{.place = {1, 0, 0}, .intensity = 7};
  const Arrivals arrivals =
      one_path(wall_at(2), {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}, emitter,
               {.most_scatterings = 1});
  ASSERT_EQ(arrivals.all.size(), 1u);
  EXPECT_NEAR(arrivals.all[0].electrons, 0.5 * 7 * 2 / std::pow(5, 1.5), 1e-14);
  EXPECT_NEAR(arrivals.all[0].path_m, 2 + std::sqrt(5), 1e-14);
  EXPECT_EQ(arrivals.all[0].scatterings, 1);
}

TEST(LightTransport, LightBehindAWallDoesNotArrive) {
  Scene scene = wall_at(2);
  scene.objects.push_back(plate(1, 0.3, 0.7));
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  EXPECT_TRUE(one_path(scene, view, {.place = {1, 0, 0}}, {.most_scatterings = 1}).all.empty());
  EXPECT_FALSE(one_path(scene, view, {.place = {2, 0, 0}}, {.most_scatterings = 1}).all.empty());
}

// A view that skips what is near sees past it; a light at its origin is behind that.
TEST(LightTransport, ViewKeepsItsInterval) {
  Scene scene = wall_at(2);
  scene.objects.push_back(plate(1, -0.5, 0.5));
  const PointEmitter lens{.place = Eigen::Vector3d::Zero()};
  Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  const auto near = one_path(scene, view, lens, {.most_scatterings = 1}).all;
  ASSERT_EQ(near.size(), 1u);
  EXPECT_NEAR(near[0].path_m, 2, 1e-14);
  view.min_m = 1.5;
  EXPECT_TRUE(one_path(scene, view, lens, {.most_scatterings = 1}).all.empty());
  EXPECT_EQ(one_path(scene, view, {.place = {2, 0, 0}}, {.most_scatterings = 1}).all.size(), 1u);
  view.max_m = 1.8;
  EXPECT_TRUE(one_path(scene, view, {.place = {2, 0, 0}}, {.most_scatterings = 1}).all.empty());
}

TEST(LightTransport, NothingSeenBringsNothing) {
  const Arrivals arrivals = one_path(
      wall_at(2), {Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()}, {.place = {1, 0, 0}}, {});
  EXPECT_TRUE(arrivals.all.empty());
  EXPECT_EQ(arrivals.other, 0);
}

// Radiance L gives pi L electrons; a point light's irradiance counts as the device's does.
TEST(LightTransport, SceneLightsCountByIrradiance) {
  Scene scene = wall_at(2);
  scene.lights = {PointLight{.position_m = {1, 0, 0}, .intensity_w_sr = 7}};
  const Ray view{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  const PointEmitter dark{.place = {0, 0, 0}, .intensity = 0};
  const Arrivals wall = one_path(scene, view, dark, {.most_scatterings = 1});
  EXPECT_NEAR(wall.other, 0.5 * 7 * 2 / std::pow(5, 1.5), 1e-14);
  EXPECT_TRUE(wall.all.empty());
  scene.lights = {Environment{.radiance_w_m2_sr = 3}};
  const Ray away{Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()};
  EXPECT_NEAR(one_path(scene, away, dark, {}).other, 3 * std::numbers::pi, 1e-14);
}

}  // namespace
}  // namespace scan::synth
