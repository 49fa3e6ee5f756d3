// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The planner's bounds for the pulsed lidar against what leaving an effect out does, each on scenes
// built to meet it: the error is within the bound and not below a tenth of it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/acquire/acquire.h"
#include "tests/synth/lidar_waveforms.h"
#include "tests/validation/effect_bounds.h"

namespace scan::synth {
namespace {

struct Case {
  const char* name;
  Effect effect;
  std::function<void(PulsedLidar&, Scene&)> build;
  EffectSet others = {};  // on in both renderings
  int renderings = 1;     // with seeds of their own: more than one where paths are chance
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

// Decoded ranges, ray by ray; NaN for a miss.
std::vector<double> ranges_m(const PulsedLidar& lidar, const RayCaster& caster, std::uint64_t seed,
                             const EffectSet& effects) {
  const Rendering rendering = render(lidar, caster, Pose::Identity(), {.seed = seed}, effects);
  const Scan scan = acquire(rendering.frames);
  std::vector<double> found(std::get<Waveforms>(rendering.frames).directions.size(), NAN);
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    found[scan.ray[i]] = scan.cloud.points[i].norm();
  return found;
}

LargestError measure(const Case& c, const PulsedLidar& lidar, const Scene& scene) {
  const EffectSet with = EffectSet(c.others).set(c.effect);
  const RayCaster on(simplified(scene, with)), off(simplified(scene, c.others));
  return largest_error(c.renderings, [&](std::uint64_t seed) {
    return minus(ranges_m(lidar, on, seed, with), ranges_m(lidar, off, seed, c.others));
  });
}

class LidarBound : public testing::TestWithParam<Case> {};

// Rounding and the sampled pulse's shape move ranges by 1e-4 m (lidar_range_test.cpp).
TEST_P(LidarBound, IsMetToATenth) {
  const Case& c = GetParam();
  PulsedLidar lidar = quiet_lidar();
  Scene scene;
  c.build(lidar, scene);
  expect_met(c.name, measure(c, lidar, scene), bound_m(lidar, scene, c.effect), 1e-4);
}

void before_a_plate(PulsedLidar& lidar, Scene& scene, double behind_m) {
  lidar.divergence_rad = 5e-3;
  lidar.sub_rays = 5;
  scene = {.objects = {plane_at(12 + behind_m), plate(12, 0.13, 3)}, .materials = {plain(0.5)}};
}

void on_the_move(PulsedLidar& lidar, Scene& scene, bool is_measured) {
  lidar.motion = {.interval_s = 1e-4,
                  .velocity_m_s = {1, 0, 10},
                  .angular_velocity_rad_s = {0, 0.5, 0},
                  .is_measured = is_measured};
  scene = scene_of(plane_at(12, 0.3), 0.5);
}

// Fog's light on the near side of a dark wall's echo; under so much ambient light that the fog
// itself is no echo, and so strong a pulse that noise does not hide what it pulls.
void in_faint_fog(PulsedLidar& lidar, Scene& scene) {
  lidar.overlap_m = 9;
  lidar.electrons_at_10m = 2e6;
  lidar.ambient_electrons = 2e4;
  lidar.sensor.gain_e_per_dn = 1;
  scene = scene_of(plane_at(12), 0.02);
  scene.medium = fog(3000, 0, 1);
}

// Fog that is the first echo itself.
void in_thick_fog(PulsedLidar& lidar, Scene& scene) {
  lidar.electrons_at_10m = 2e6;
  lidar.overlap_m = 3;
  lidar.sensor.gain_e_per_dn = 20;
  scene = scene_of(plane_at(12), 0.1);
  scene.medium = fog(60, 0.5, 1);
}

// A wide beam in a small sphere: light that comes over two and more places of it is late.
void in_a_sphere(PulsedLidar& lidar, Scene& scene) {
  lidar.divergence_rad = 0.3;
  lidar.sub_rays = 2;
  lidar.electrons_at_10m = 10;
  lidar.ambient_electrons = 0;
  lidar.sensor.read_noise_e = 0;  // so that the echo's tail weighs as much as its middle
  lidar.min_range_m = 0.3;
  scene = scene_of(sphere_at({0, 0, 0}, 0.6), 0.8);
}

// A wall of loose wax: light comes back by its mean free path of 10 cm later.
void before_wax(PulsedLidar& lidar, Scene& scene) {
  lidar.sensor.gain_e_per_dn = 1;
  scene = scene_of(plane_at(4), 0.5);
  scene.materials[0] = {.name = "wax",
                        .bsdf = Dielectric{.index = 1},
                        .interior = Medium{.absorption_per_m = 0.5, .scattering_per_m = 9.5}};
}

Pose turned_about_y(double turn_rad, const Eigen::Vector3d& place) {
  return make_pose(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix(), place);
}

// A wall beside the beam, facing it.
Object side_wall(double x_m, int material) {
  Object wall = plane_at(0, 0, material);
  wall.world_from_object =
      turned_about_y(x_m < 0 ? std::numbers::pi / 2 : -std::numbers::pi / 2, {x_m, 0, 0});
  return wall;
}

// Half of a wide beam meets a wall, half a mirror before it that shows another one.
void beside_a_mirror(PulsedLidar& lidar, Scene& scene) {
  lidar.pattern = RasterPattern{.rows = 10, .columns = 12, .height_rad = 0.02, .width_rad = 0.02};
  lidar.divergence_rad = 0.02;
  lidar.sub_rays = 4;
  lidar.max_range_m = 20;
  scene.materials = {plain(0.9),
                     {.name = "mirror", .bsdf = Conductor{.eta = 0.15, .k = 5.7, .roughness = 0}}};
  Object mirror = plate(0, -2, 0, 1);
  mirror.world_from_object = turned_about_y(std::numbers::pi / 4, {0, 0, 3});
  scene.objects = {plane_at(12), mirror, side_wall(-2, 0)};
}

// A pane at 45 degrees shows a bright wall at its side before the dark one behind it.
void behind_a_pane(PulsedLidar& lidar, Scene& scene) {
  lidar.electrons_at_10m = 2e6;
  lidar.sensor.gain_e_per_dn = 16;
  lidar.max_range_m = 20;
  scene.materials = {plain(0.01), {.name = "glass", .bsdf = Dielectric{1.5}}, plain(0.9)};
  scene.objects = {plane_at(15),
                   {.name = "pane",
                    .world_from_object = turned_about_y(std::numbers::pi / 4, {0, 0, 3}),
                    .geometry = Shape(BoxShape{{4, 4, 0.01}}),
                    .material = 1},
                   side_wall(-2, 2)};
}

void walking(PulsedLidar& lidar, Scene& scene) {
  lidar.range_walk = {.per_decade_s = -0.2e-9, .at_electrons = 1000};
  scene = scene_of(plane_at(12, 0.3), 0.05);
}

// As above, behind a pane that takes a sixth of the light.
void walking_behind_a_pane(PulsedLidar& lidar, Scene& scene) {
  walking(lidar, scene);
  scene.materials.push_back({.name = "glass", .bsdf = Dielectric{1.5}});
  scene.objects.push_back({.name = "pane",
                           .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {0, 0, 6}),
                           .geometry = Shape(BoxShape{{9, 9, 0.01}}),
                           .material = 1});
}

// Steps of a tenth of the echo's height.
void in_coarse_steps(PulsedLidar& lidar, Scene& scene) {
  lidar.sensor = {.gain_e_per_dn = 100, .bits = 8};
  scene = scene_of(plane_at(12, 0.3), 0.3);
}

INSTANTIATE_TEST_SUITE_P(
    All, LidarBound,
    testing::Values(
        Case{"footprint_merged", Effect::footprint,
             [](auto& s, auto& scene) { before_a_plate(s, scene, 0.1); }},
        Case{"footprint_parted", Effect::footprint,
             [](auto& s, auto& scene) { before_a_plate(s, scene, 3); }},
        Case{"motion_measured", Effect::motion,
             [](auto& s, auto& scene) { on_the_move(s, scene, true); }},
        Case{"motion_unknown", Effect::motion,
             [](auto& s, auto& scene) { on_the_move(s, scene, false); }},
        Case{"range_walk", Effect::range_walk, walking},
        Case{"range_walk_behind_glass",
             Effect::range_walk,
             walking_behind_a_pane,
             {Effect::refraction},
             8},
        Case{"faint_fog", Effect::medium, in_faint_fog},
        Case{"thick_fog", Effect::medium, in_thick_fog},
        Case{"interreflection", Effect::interreflection, in_a_sphere, {Effect::footprint}, 8},
        Case{"subsurface", Effect::subsurface, before_wax, {}, 8},
        Case{"mirror", Effect::mirror_reflection, beside_a_mirror, {Effect::footprint}, 8},
        Case{"glass", Effect::refraction, behind_a_pane, {Effect::mirror_reflection}, 8},
        Case{"quantisation", Effect::quantisation, in_coarse_steps}),
    [](const auto& c) { return std::string(c.param.name); });

// Noise has no bound; three sigma of it, by the closed form, against the spread of the decoded
// ranges of a wall. 1200 ranges: four standard errors are 8 %; the wall's corners send back 4 %
// less than its middle, whose bound would be 2 % less.
class LidarNoiseBound : public testing::TestWithParam<Effect> {};

double spread_m(const PulsedLidar& lidar, const Scene& scene, const EffectSet& effects) {
  const RayCaster caster(simplified(scene, effects));
  const auto directions = ray_directions(lidar);
  double squares = 0, count = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto found = ranges_m(lidar, caster, seed, effects);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (std::isnan(found[i])) continue;
      squares += std::pow(found[i] - 12 / directions[i].z(), 2);
      ++count;
    }
  }
  EXPECT_EQ(count, 1200);
  return std::sqrt(squares / count);
}

TEST_P(LidarNoiseBound, IsThreeSigma) {
  PulsedLidar lidar = quiet_lidar();
  lidar.electrons_per_w_m2 = 2000;
  Scene scene = scene_of(plane_at(12), 0.1);
  const bool is_light = GetParam() == Effect::scene_lights;
  if (is_light) scene.lights.push_back(PointLight{.position_m = {0, 3, 0}, .intensity_w_sr = 144});
  const EffectSet others =
      is_light ? EffectSet{Effect::shot_noise, Effect::read_noise} : EffectSet{};
  const double with = spread_m(lidar, scene, EffectSet(others).set(GetParam()));
  const double sigma_m = with - (is_light ? spread_m(lidar, scene, others) : 0);
  const double bound = bound_m(lidar, scene, GetParam());
  std::printf("bound: %-24s %9.4g mm, three sigma %.4g mm\n", std::string(name(GetParam())).c_str(),
              bound * 1e3, 3e3 * sigma_m);
  EXPECT_NEAR(3 * sigma_m / bound, 1, 0.1);
}

INSTANTIATE_TEST_SUITE_P(All, LidarNoiseBound,
                         testing::Values(Effect::shot_noise, Effect::read_noise,
                                         Effect::scene_lights),
                         [](const auto& effect) {
                           std::string word(name(effect.param));
                           std::replace(word.begin(), word.end(), ' ', '_');
                           return word;
                         });

}  // namespace
}  // namespace scan::synth
