// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The planner's bounds for a stereo pair of what light does on its way, each on a scene built to
// meet it: mirrors, panes and gloss show something else, wax is seen into, lights and fog change
// the noise.
#include <algorithm>
#include <map>
#include <numbers>

#include "libscan/acquire/acquire.h"
#include "tests/validation/effect_bounds.h"
#include "tests/validation/stereo_bench.h"

namespace scan::synth {
namespace {

// The middle of the larger pair's images, for paths take time.
StereoPair pair_of_100_px() {
  StereoPair pair = pair_of_200_px();
  pair.calibration.width_px = 100;
  pair.calibration.height_px = 40;
  pair.calibration.cx_px = 49.5;
  pair.calibration.cy_px = 19.5;
  return pair;
}

Scan scan_of(const StereoPair& pair, const Scene& scene, const EffectSet& effects) {
  const RayCaster caster(simplified(scene, effects));
  return acquire(render(pair, caster, Pose::Identity(), {.seed = 5}, effects).frames);
}

double quantile_of(std::vector<double> values, double share) {
  EXPECT_GT(values.size(), 100u);
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// Half of the errors reach a tenth of the bound, all but a hundredth are within it: matches at the
// image's borders.
void expect_within(const char* what, const std::vector<double>& errors_m, double bound_m) {
  const double half_m = quantile_of(errors_m, 0.5), most_m = quantile_of(errors_m, 0.99);
  std::printf("bound: %-24s %9.4g mm, error %.4g mm, at most %.4g mm, %.2f of it\n", what,
              bound_m * 1e3, half_m * 1e3, most_m * 1e3, half_m / bound_m);
  EXPECT_LE(most_m, bound_m);
  EXPECT_GE(half_m, bound_m / 10);
}

Object turned_plane(double turn_rad, const Eigen::Vector3d& place, int material) {
  const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitY());
  Object plane = plane_at(0, 0, material);
  plane.world_from_object = make_pose(turn.toRotationMatrix(), place);
  return plane;
}

Material print(double period_m) {
  return {.name = "print", .bsdf = Lambert{0.9}, .texture = NoiseTexture{period_m, 1, 0.9}};
}

// At 45 degrees it turns the view to a printed wall 3.5 m beside it.
Scene beside_a_wall(const Object& turning, const Bsdf& bsdf) {
  return {.objects = {turning, turned_plane(std::numbers::pi / 2, {-3.5, 0, 0}, 1)},
          .materials = {{.name = "turning", .bsdf = bsdf}, print(0.1)}};
}

// Without the effect no texture is there to be matched; the range left out is that of the surface
// itself. `truth` is the scene whose first surfaces these are.
std::vector<double> ghost_errors_m(const StereoPair& pair, const Scene& scene, const Scene& truth,
                                   const EffectSet& effects) {
  const auto rays = true_rays(pair, RayCaster(truth), Pose::Identity());
  const Scan seen = scan_of(pair, scene, effects);
  std::vector<double> errors;
  for (std::size_t i = 0; i < seen.ray.size(); ++i)
    errors.push_back((seen.cloud.points[i] - rays[seen.ray[i]].point_in_scanner).norm());
  return errors;
}

TEST(StereoWays, OverAMirrorShowAGhostWithinTheirBound) {
  const StereoPair pair = pair_of_100_px();
  const Scene scene = beside_a_wall(plane_at(0.5, std::numbers::pi / 4), Conductor{.roughness = 0});
  expect_within("mirror", ghost_errors_m(pair, scene, scene, {Effect::mirror_reflection}),
                bound_m(pair, scene, Effect::mirror_reflection));
}

// A pane shows the wall before a dark one without texture, 1 m away.
TEST(StereoWays, OverAPaneShowAGhostWithinTheirBound) {
  StereoPair pair = pair_of_100_px();
  pair.ambient_electrons = 20000;
  pair.calibration.height_px = 20;
  pair.calibration.cy_px = 9.5;
  Object pane{.name = "pane", .geometry = Shape(BoxShape{{4, 4, 0.002}}), .material = 0};
  pane.world_from_object = turned_plane(std::numbers::pi / 4, {0, 0, 0.5}, 0).world_from_object;
  Scene scene = beside_a_wall(pane, Dielectric{1.5});
  scene.materials.push_back(plain(0.01));
  scene.objects.push_back(plane_at(1, 0, 2));
  const EffectSet effects = {Effect::refraction, Effect::mirror_reflection};
  expect_within("pane", ghost_errors_m(pair, scene, without_clear_objects(scene), effects),
                bound_m(pair, scene, Effect::refraction));
}

// Polished metal in the light of a lamp shows the wall that the lamp lights.
TEST(StereoWays, OverGlossShowAGhostWithinTheirBound) {
  StereoPair pair = pair_of_100_px();
  pair.ambient_electrons = 0;
  pair.sensor.read_noise_e = 60;  // not drawn: how well paths need to be known
  pair.calibration.height_px = 20;
  pair.calibration.cy_px = 9.5;
  Scene scene = beside_a_wall(plane_at(0.5, std::numbers::pi / 4), Conductor{.roughness = 0.01});
  scene.lights.push_back(PointLight{.position_m = {-1, 1, 0.2}, .intensity_w_sr = 15});
  const EffectSet effects = {Effect::interreflection, Effect::scene_lights};
  expect_within("gloss", ghost_errors_m(pair, scene, scene, effects),
                bound_m(pair, scene, Effect::interreflection));
}

// Dots on a wall of wax, of 1 cm of free path: each is seen where its light was scattered last. The
// mean over the matches, for each alone errs by the images' rounding; rows next to each other share
// it, windows of 7 x 7 do not: its standard error is that of a 49th of them.
TEST(StereoWays, IntoWaxEndWithinTheirBound) {
  StereoPair pair = pair_of_100_px();
  pair.calibration.height_px = 20;
  pair.calibration.cy_px = 9.5;
  pair.calibration.min_disparity_px = 20;
  pair.calibration.disparities_px = 20;
  pair.ambient_electrons = 0;
  pair.projector_electrons = 3000;
  pair.projector_dots = 10;
  pair.focus_m = 0.6;
  pair.sensor.read_noise_e = 60;  // not drawn: how well paths need to be known
  Scene scene{.objects = {plane_at(0.6)}, .materials = {{.name = "wax"}}};
  scene.materials[0].bsdf = Dielectric{.index = 1};
  scene.materials[0].interior = Medium{.absorption_per_m = 40, .scattering_per_m = 60};
  const auto rays = true_rays(pair, RayCaster(scene), Pose::Identity());
  const Scan seen = scan_of(pair, scene, {Effect::subsurface});
  double sum_m = 0, squares_m2 = 0;
  for (std::size_t i = 0; i < seen.ray.size(); ++i) {
    const double error_m = seen.cloud.points[i].norm() - rays[seen.ray[i]].point_in_scanner.norm();
    sum_m += error_m;
    squares_m2 += error_m * error_m;
  }
  const auto count = static_cast<double>(seen.ray.size());
  ASSERT_GT(count, 500);
  const double mean_m = sum_m / count;
  const double error_m = std::sqrt((squares_m2 / count - mean_m * mean_m) / (count / 49 - 1));
  const double bound = bound_m(pair, scene, Effect::subsurface);
  std::printf("bound: %-24s %9.4g mm, error %.4g mm +- %.2g mm, %.2f of it\n", "subsurface",
              bound * 1e3, mean_m * 1e3, error_m * 1e3, mean_m / bound);
  EXPECT_LE(mean_m + 3 * error_m, bound);
  EXPECT_GE(mean_m - 3 * error_m, bound / 10);
}

// What changes three sigmas, as the decoder states them, at 95 of 100 matches: it takes the noise
// from its windows' residuals, a seventh of which is chance in windows of 49 pixels.
void expect_sigma_change(const char* what, const StereoPair& pair, const Scene& scene,
                         Effect effect) {
  EffectSet with = {Effect::shot_noise, Effect::read_noise};
  std::map<std::uint32_t, double> without_m;
  const Scan without = scan_of(pair, scene, with);
  for (std::size_t i = 0; i < without.ray.size(); ++i)
    without_m[without.ray[i]] = without.cloud.sigma_m[i];
  const Scan scan = scan_of(pair, scene, with.set(effect));
  std::vector<double> changes;
  for (std::size_t i = 0; i < scan.ray.size(); ++i)
    if (const auto other = without_m.find(scan.ray[i]); other != without_m.end())
      changes.push_back(3 * std::abs(scan.cloud.sigma_m[i] - other->second));
  const double most_m = quantile_of(changes, 0.95);
  const double bound = bound_m(pair, scene, effect);
  std::printf("bound: %-24s %9.4g mm, error %.4g mm, %.2f of it\n", what, bound * 1e3, most_m * 1e3,
              most_m / bound);
  EXPECT_LE(most_m, bound);
  EXPECT_GE(most_m, bound / 10);
}

TEST(StereoWays, UnderALampHaveTheNoiseOfItsLight) {
  StereoPair pair = pair_of_100_px();
  pair.ambient_electrons = 1000;
  Scene scene = printed_plane(0.2);
  scene.lights.push_back(PointLight{.position_m = {0, 1, 0}, .intensity_w_sr = 3});
  expect_sigma_change("scene lights", pair, scene, Effect::scene_lights);
}

TEST(StereoWays, ThroughFogHaveTheNoiseOfItsVeil) {
  const StereoPair pair = pair_of_100_px();
  Scene scene = printed_plane(0.2);
  scene.medium = Medium{.scattering_per_m = 1};
  expect_sigma_change("fog", pair, scene, Effect::medium);
}

// Smoke adds no veil: what it takes of the light is all.
TEST(StereoWays, ThroughSmokeHaveTheNoiseOfWeakerLight) {
  const StereoPair pair = pair_of_100_px();
  Scene scene = printed_plane(0.2);
  scene.medium = Medium{.absorption_per_m = 1};
  expect_sigma_change("smoke", pair, scene, Effect::medium);
}

}  // namespace
}  // namespace scan::synth
