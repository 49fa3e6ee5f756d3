// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The planner's bounds for a phase camera of what adds noise, shows ghosts or comes out of bodies
// and fog, against decoded scans; those of the device are in
// tests/synth/weigh_phase_camera_test.cpp.
#include <algorithm>

#include "libscan/acquire/phase.h"
#include "tests/synth/phase_bench.h"
#include "tests/validation/effect_bounds.h"

namespace scan::synth {
namespace {

// 48 x 32 px; the wall turns the light by 0.3 rad.
PhaseCamera camera() {
  PhaseCamera camera = small_camera();
  camera.frequencies_hz = {80e6, 120e6};
  camera.sensor = {.gain_e_per_dn = 0.25, .full_well_e = 1e6, .bits = 16};
  camera.max_range_m = 3;
  return camera;
}

Scene wall() {
  return {.objects = {plane_at(1.5, 0.3)}, .materials = {plain(0.6)}};
}

void print(Effect effect, double bound_m, double error_m) {
  std::printf("bound: %-24s %9.4g mm, error %.4g mm, %.2f of it\n",
              std::string(name(effect)).c_str(), bound_m * 1e3, error_m * 1e3, error_m / bound_m);
}

Weight weight_of(const PhaseCamera& camera, const Scene& scene, Effect effect) {
  const auto rays = pilot(camera, RayCaster(scene), Pose::Identity(), 48 * 32);
  const Weighed weighed = weigh(camera, scene, effect, rays);
  EXPECT_TRUE(weighed.weight) << weighed.why_absent;
  return weighed.weight.value_or(Weight{});
}

// Range errors by the noise alone, each over the bound; bound: three of the largest sigma.
TEST(PhaseBounds, OfNoiseAreThreeSigma) {
  for (const Effect effect : {Effect::shot_noise, Effect::read_noise}) {
    PhaseCamera device = camera();
    device.sensor.read_noise_e = effect == Effect::read_noise ? 60 : 0;
    const Scene scene = wall();
    const Scan with = acquire_phase(taps_of(device, scene, {effect}));
    const Scan without = acquire_phase(taps_of(device, scene, {}));
    ASSERT_EQ(with.ray, without.ray);
    const Weight weight = weight_of(device, scene, effect);
    std::vector<double> moved_m;
    for (std::size_t i = 0; i < with.ray.size(); ++i)
      moved_m.push_back((with.cloud.points[i] - without.cloud.points[i]).norm());
    std::sort(moved_m.begin(), moved_m.end());
    // 2.58 sigma of the mean pixel, whose sigma is less than the largest
    const double most_m = moved_m[moved_m.size() * 99 / 100];
    print(effect, weight.bound_m, most_m);
    EXPECT_LE(most_m, weight.bound_m) << name(effect);
    EXPECT_GE(most_m, weight.bound_m / 10) << name(effect);
  }
}

// What makes an effect's light: three of the change of sigma that the decoder states.
void expect_sigma_bound(const PhaseCamera& device, const Scene& scene, Effect effect) {
  const Scan with = acquire_phase(taps_of(device, scene, {effect}));
  const Scan without = acquire_phase(taps_of(device, simplified(scene, {}), {}));
  ASSERT_EQ(with.ray, without.ray);
  const Weight weight = weight_of(device, scene, effect);
  std::vector<double> changes_m;
  for (std::size_t i = 0; i < with.ray.size(); ++i)
    changes_m.push_back(3 * (with.cloud.sigma_m[i] - without.cloud.sigma_m[i]));
  std::sort(changes_m.begin(), changes_m.end());
  const double most_m = changes_m[changes_m.size() * 99 / 100];
  print(effect, weight.bound_m, most_m);
  // the decoder tells its sigma by one reading of the amplitude, good to some per cent here
  EXPECT_LE(most_m, 1.05 * weight.bound_m) << name(effect);
  EXPECT_GE(most_m, weight.bound_m / 10) << name(effect);
}

TEST(PhaseBounds, OfVignettingIsThatOfWeakerLight) {
  PhaseCamera device = camera();
  device.vignetting = 1;
  expect_sigma_bound(device, wall(), Effect::vignetting);
}

TEST(PhaseBounds, OfSceneLightsIsThatOfTheirNoise) {
  PhaseCamera device = camera();
  device.electrons_per_w_m2 = 1000;
  Scene scene = wall();
  scene.lights.push_back(PointLight{.position_m = {0, 1, 0}, .intensity_w_sr = 30});
  expect_sigma_bound(device, scene, Effect::scene_lights);
}

// A mirror at 0.6 m turns the view to a wall 1.5 m beside it: the ghost is 1.5 m behind the mirror,
// farther than the mirror itself and half of the 3 m that the camera tells apart.
TEST(PhaseBounds, OfAMirrorIsReachedByAGhost) {
  const PhaseCamera device = camera();
  Scene scene{.objects = {plane_at(0.6, std::numbers::pi / 4), plane_at(0, 0, 1)},
              .materials = {{.name = "mirror", .bsdf = Conductor{.roughness = 0}, .texture = {}},
                            plain(0.5)}};
  const Eigen::AngleAxisd sideways(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
  scene.objects[1].world_from_object = make_pose(sideways.toRotationMatrix(), {-1.5, 0, 0});
  const Scan seen = acquire_phase(taps_of(device, scene, {Effect::mirror_reflection}));
  const auto truth = true_rays(device, RayCaster(scene), Pose::Identity());
  ASSERT_GT(seen.ray.size(), 1000u);
  double most_m = 0;
  for (std::size_t i = 0; i < seen.ray.size(); ++i)
    most_m = std::max(most_m, (seen.cloud.points[i] - truth[seen.ray[i]].point_in_scanner).norm());
  const double bound_m = weight_of(device, scene, Effect::mirror_reflection).bound_m;
  print(Effect::mirror_reflection, bound_m, most_m);
  EXPECT_LE(most_m, bound_m);
  EXPECT_GE(most_m, bound_m / 10);
}

// A scene whose light takes other ways, and what is on in both renderings.
struct Ways {
  const char* name;
  Effect effect;
  void (*build)(PhaseCamera&, Scene&);
  EffectSet others = {};
};

void PrintTo(const Ways& ways, std::ostream* out) {
  *out << ways.name;
}

// Decoded ranges, pixel by pixel; NaN for a miss.
std::vector<double> ranges_m(const PhaseCamera& device, const Scene& scene,
                             const EffectSet& effects, std::uint64_t seed) {
  const Scan scan =
      acquire_phase(taps_of(device, simplified(scene, effects), effects, {.seed = seed}));
  std::vector<double> found(
      static_cast<std::size_t>(device.camera.width_px) * device.camera.height_px, NAN);
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    found[scan.ray[i]] = scan.cloud.points[i].norm();
  return found;
}

class PhaseWays : public testing::TestWithParam<Ways> {};

// Without noise or rounding: what is left of chance is that of light's paths, as many as the read
// noise, which is not drawn, calls for.
TEST_P(PhaseWays, MeetTheirBoundToATenth) {
  const Ways& ways = GetParam();
  PhaseCamera device = camera();
  device.camera = {
      .width_px = 4, .height_px = 4, .fx_px = 30, .fy_px = 30, .cx_px = 1.5, .cy_px = 1.5};
  device.sensor.read_noise_e = 40;
  Scene scene;
  ways.build(device, scene);
  const EffectSet with = EffectSet(ways.others).set(ways.effect);
  const LargestError error = largest_error(8, [&](std::uint64_t seed) {
    return minus(ranges_m(device, scene, with, seed), ranges_m(device, scene, ways.others, seed));
  });
  expect_met(ways.name, error, bound_m(device, scene, ways.effect));
}

// A pane at 45 degrees shows a bright wall at its side before the dark one behind it.
void behind_a_pane(PhaseCamera& device, Scene& scene) {
  const auto turned = [](double turn_rad, const Eigen::Vector3d& place) {
    const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitY());
    return make_pose(turn.toRotationMatrix(), place);
  };
  device.frequencies_hz = {20e6};  // two would not agree on a mixture
  device.electrons_at_1m = 2e7;
  device.sensor = {.gain_e_per_dn = 32, .read_noise_e = 400, .full_well_e = 2e6, .bits = 16};
  scene.materials = {plain(0.01), {.name = "glass", .bsdf = Dielectric{1.5}}, plain(0.9)};
  scene.objects = {plane_at(2.9),
                   {.name = "pane",
                    .world_from_object = turned(std::numbers::pi / 4, {0, 0, 1}),
                    .geometry = Shape(BoxShape{{4, 4, 0.01}}),
                    .material = 1},
                   plane_at(0, 0, 2)};
  scene.objects[2].world_from_object = turned(std::numbers::pi / 2, {-0.5, 0, 0});
}

// Light goes a centimetre into the wall and more, and some of it comes back.
void before_wax(PhaseCamera&, Scene& scene) {
  scene = wall();
  scene.materials[0] = {.name = "wax",
                        .bsdf = Dielectric{.index = 1},
                        .interior = Medium{.absorption_per_m = 5, .scattering_per_m = 95}};
}

// Fog before a dark wall sends back light of all distances.
void in_fog(PhaseCamera& device, Scene& scene) {
  device.frequencies_hz = {20e6};
  device.emitter_offset_m = 0.2;
  scene = {.objects = {plane_at(1.5)}, .materials = {plain(0.2)}};
  scene.medium = Medium{.scattering_per_m = 0.02};
}

INSTANTIATE_TEST_SUITE_P(
    All, PhaseWays,
    testing::Values(Ways{"pane", Effect::refraction, behind_a_pane, {Effect::mirror_reflection}},
                    Ways{"subsurface", Effect::subsurface, before_wax},
                    Ways{"fog", Effect::medium, in_fog}),
    [](const auto& ways) { return std::string(ways.param.name); });

}  // namespace
}  // namespace scan::synth
