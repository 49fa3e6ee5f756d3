// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_paths.h"

#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

Scene room_corner() {
  return {.objects = {plane_at(1.5, pi / 4), plane_at(1.5, -pi / 4)}, .materials = {plain(0.8)}};
}

// Sample's rays carry what crosses a sphere around the light: irradiance times its area.
TEST(Flash, SendsOutWhatItIrradiates) {
  PhaseCamera camera = small_camera();
  camera.emitter_offset_m = 0.1;
  const Flash flash(camera, Pose::Identity());
  EXPECT_EQ(flash.position(), Eigen::Vector3d(0.1, 0, 0));
  const double through_sphere = flash.irradiance(Eigen::Vector3d::UnitX(), 3) * 4 * pi * 9;
  EXPECT_NEAR(flash.flux(), through_sphere, 1e-9 * through_sphere);
  EXPECT_EQ(flash.sample({0.3, 0.7}).flux, flash.flux());
  EXPECT_NEAR(flash.sample({0.3, 0.7}).direction.norm(), 1, 1e-12);
}

// Paths of one scattering, through the pixel's centre: next-event estimation is exact there, so
// each path brings the direct light of phase_light.cpp, a second way to the same numbers.
TEST(PhasePaths, BringDirectLightByTheirFirstScattering) {
  PhaseCamera camera = small_camera();
  camera.emitter_offset_m = 0.05;
  camera.vignetting = 1;
  camera.harmonics = {0, 0.05};
  camera.ambient_electrons = 300;
  const Scene scene{.objects = {plane_at(2, 0.4), plate(1.2, -0.3, 0)}, .materials = {plain(0.7)}};
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 1});
  const PathView view{camera, transport, Pose::Identity(), {}, {}};
  const std::vector<Tone> tones = tones_of(camera);
  EstimateMemory memory;
  Estimate taps;
  for (const auto& [column, row] : {std::pair(3, 3), {17, 20}, {40, 9}, {24, 1}}) {
    estimate_taps(view, tones, {column, row}, 0, 0.02, {}, memory, taps);
    PixelPhasors light = light_at(camera, scene, column, row);
    for (std::size_t t = 0; t < tones.size(); ++t)  // 0.02 m further there and back
      light.amplitude_e[t] *= std::polar(1.0, tones[t].rad_per_m * 2 * 0.02);
    ASSERT_EQ(taps.mean.size(), 12u);
    EXPECT_EQ(taps.samples, 16);
    EXPECT_EQ(taps.standard_error.size(), 12u);
    for (int f = 0; f < 3; ++f)
      for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(taps.mean[4 * f + k], mean_tap(camera, light, f, k), 1e-9 * light.constant_e);
  }
}

// One tap of a moving camera is the same as that tap among all.
TEST(PhasePaths, ExposeOneTapAlone) {
  const PhaseCamera camera = small_camera();
  const Scene scene = room_corner();
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 1});
  EstimateMemory memory;
  Estimate all, one;
  const PathView view{camera, transport, Pose::Identity(), {}, {}};
  estimate_taps(view, tones_of(camera), {20, 9}, 0, 0.01, {}, memory, all);
  const PathView single{camera, transport, Pose::Identity(), {.frequency = 2, .tap = 3}, {}};
  estimate_taps(single, tones_of(camera, single.exposure), {20, 9}, 0, 0.01, {}, memory, one);
  ASSERT_EQ(one.mean.size(), 1u);
  EXPECT_NEAR(one.mean[0], all.mean[11], 1e-9 * all.mean[11]);
}

TEST(PhasePaths, AreCalledForByWhatTheSceneHolds) {
  PhaseCamera camera = small_camera();
  Scene scene = room_corner();
  const auto need = [&](const EffectSet& effects) { return path_need(camera, scene, effects); };
  EXPECT_EQ(need({}), PathNeed::none);
  EXPECT_EQ(need({Effect::footprint, Effect::motion, Effect::mirror_reflection}), PathNeed::none);
  EXPECT_EQ(need({Effect::interreflection}), PathNeed::interreflection);
  EXPECT_EQ(need(EffectSet::all()), PathNeed::all) << "everywhere";
  scene.medium = Medium{};
  EXPECT_EQ(need({Effect::medium}), PathNeed::all);
  EXPECT_EQ(need({Effect::scene_lights}), PathNeed::none);
  scene.lights.push_back(Environment{});
  EXPECT_EQ(need({Effect::scene_lights}), PathNeed::none);  // the sensor does not see it
  camera.electrons_per_w_m2 = 1;
  EXPECT_EQ(need({Effect::scene_lights}), PathNeed::all);
  scene.materials[0].bsdf = Conductor{.roughness = 0};
  EXPECT_EQ(need({Effect::mirror_reflection}), PathNeed::all);
  EXPECT_EQ(need({Effect::refraction}), PathNeed::none);
  scene.materials[0].bsdf = Dielectric{};
  EXPECT_EQ(need({Effect::refraction}), PathNeed::all);
}

TEST(PhasePaths, MatterWhereSurfacesFaceEachOther) {
  const PhaseCamera camera = small_camera();
  const auto matter = [&](const Scene& scene) {
    const RayCaster caster(scene);
    const LightTransport transport(caster, transport_options({Effect::interreflection}, false));
    const PathView view{camera, transport, Pose::Identity(), {}, {}};
    const auto pixels = surroundings_matter(view, tones_of(camera));
    return std::count(pixels.begin(), pixels.end(), 1);
  };
  EXPECT_EQ(matter(room_corner()), 48 * 32);
  EXPECT_EQ(matter({.objects = {plane_at(1.5, 0.3)}, .materials = {plain(0.8)}}), 0);
}

// Where light has one surface to meet the direct renderer serves: the same bytes.
TEST(PhasePaths, LeaveALonelyPlaneAlone) {
  const PhaseCamera camera = small_camera();
  const Scene scene{.objects = {plane_at(1.5, 0.3)}, .materials = {plain(0.8)}};
  const EffectSet with = EffectSet(sensor_effects).set(Effect::interreflection);
  EXPECT_EQ(taps_of(camera, scene, with).taps[2][1].pixels,
            taps_of(camera, scene, sensor_effects).taps[2][1].pixels);
}

Rendering corner_rendering() {
  PhaseCamera camera = small_camera();
  camera.camera.width_px = 12;
  camera.camera.height_px = 8;
  camera.electrons_at_1m = 500;
  return render(camera, RayCaster(room_corner()), Pose::Identity(), {},
                EffectSet(sensor_effects).set(Effect::interreflection));
}

// Taps are asked for to 0.5 of their noise (2.5 times 0.2). The 96 pixels see one wall and share
// their paths, at least 1024; pixels of their own would take 64 each.
TEST(PhasePaths, AreAsManyAsTheNoiseCallsFor) {
  const Rendering rendering = corner_rendering();
  EXPECT_GE(rendering.statistics.paths, 1024u);
  EXPECT_LE(rendering.statistics.paths, 64u * 12 * 8);
  EXPECT_GT(rendering.statistics.sampling_error_rms, 0);
  EXPECT_LE(rendering.statistics.sampling_error_rms, 0.5);
  EXPECT_LE(rendering.statistics.sampling_error_max, 2);
}

// The spread of phases over repetitions, in the noise of a phase (sqrt(variance / 2) / A): a goal
// of 0.2 that streams may miss a little; the taps' own spread is larger.
TEST(PhasePaths, MeetTheirGoalInPhase) {
  PhaseCamera camera = small_camera();
  const Scene scene = room_corner();
  const RayCaster caster(scene);
  const LightTransport transport(caster, transport_options({Effect::interreflection}, false));
  EstimateMemory memory;
  Estimate taps;
  double square = 0;
  constexpr int repetitions = 40;
  std::vector<Phasor> found;
  Phasor mean = 0;
  double tap_e = 0;
  for (std::uint64_t seed = 0; seed < repetitions; ++seed) {
    const PathView view{camera, transport, Pose::Identity(), {}, {.seed = seed, .scan = 0}};
    estimate_taps(view, tones_of(camera), {20, 9}, 0, 0, {.least_samples = 64}, memory, taps);
    found.emplace_back(taps.mean[8] - taps.mean[10], taps.mean[11] - taps.mean[9]);
    mean += found.back() / (1.0 * repetitions);
    tap_e += (taps.mean[8] + taps.mean[9] + taps.mean[10] + taps.mean[11]) / 4 / repetitions;
  }
  for (const Phasor& one : found) square += std::pow(std::arg(one * std::conj(mean)), 2);
  const double noise = std::sqrt(tap_variance_e2(camera.sensor, tap_e) / 2) / (std::abs(mean) / 2);
  // the deviation of 39 degrees of freedom scatters by 1 / sqrt(78)
  EXPECT_LT(std::sqrt(square / (repetitions - 1)) / noise, 0.2 * (1 + 4 / std::sqrt(78.0)));
}

TEST(PhasePaths, AreTheSameForAnyThreadCount) {
  expect_same_for_any_thread_count([] {
    const Rendering rendering = corner_rendering();
    return std::pair(std::get<PhaseTaps>(rendering.frames).taps[1][2].pixels,
                     rendering.statistics.sampling_error_rms);
  });
}

// The scene's lights add to every tap alike: electrons_per_w_m2 times the irradiance times the
// albedo. Under an even sky of radiance L a plane gets pi L; the mean over paths of it is exact for
// next-event estimation and BSDF sampling under the balance heuristic to its standard error.
TEST(PhasePaths, AddTheScenesLights) {
  PhaseCamera camera = small_camera();
  camera.electrons_per_w_m2 = 100;
  const Scene scene{.objects = {plane_at(2)},
                    .materials = {plain(0.7)},
                    .lights = {Environment{.radiance_w_m2_sr = 2, .map = {}}}};
  const RayCaster caster(scene);
  const LightTransport transport(caster, {.most_scatterings = 1});
  const PathView view{camera, transport, Pose::Identity(), {}, {}};
  EstimateMemory memory;
  Estimate taps;
  estimate_taps(view, tones_of(camera), {10, 10}, 0, 0,
                {.share_of_noise = 0, .least_samples = 4096, .most_samples = 4096}, memory, taps);
  const PixelPhasors own = light_at(camera, scene, 10, 10);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(taps.mean[k], mean_tap(camera, own, 0, k) + 100 * 0.7 * pi * 2,
                1e-6 + 8 * taps.standard_error[k]);
}

}  // namespace
}  // namespace scan::synth
