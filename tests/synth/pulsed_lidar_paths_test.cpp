// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The lidar's light over mirrors, through glass, from wall to wall.
#include "synth/scanners/pulsed_lidar_paths.h"

#include <cmath>
#include <numeric>

#include "synth/bsdf/fresnel.h"
#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

const EffectSet light_effects = {
    Effect::interreflection, Effect::mirror_reflection, Effect::refraction, Effect::subsurface,
    Effect::medium,          Effect::scene_lights,      Effect::footprint};

PulsedLidar wide_beam() {
  PulsedLidar lidar = small_lidar();
  lidar.divergence_rad = 4e-3;
  lidar.sub_rays = 4;
  lidar.ambient_electrons = 0;
  return lidar;
}

// What paths alone add to the waveform of the beam along +z.
std::vector<double> path_waveform(const PulsedLidar& lidar, const Scene& scene,
                                  const EffectSet& effects = light_effects) {
  const RayCaster caster(scene);
  const SampleAxis axis = sample_axis(lidar);
  const LidarPaths paths(lidar, caster, effects, axis);
  std::vector<double> samples(static_cast<std::size_t>(axis.samples));
  LidarPaths::Memory memory;
  const Pose pose = Pose::Identity();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  paths.add({pose, ahead, {}, 0}, {}, samples, memory);
  return samples;
}

Object turned_plane(double z_m, double turn_rad, int material) {
  const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitY());
  return {.name = "plane",
          .world_from_object = make_pose(turn.toRotationMatrix(), {0, 0, z_m}),
          .geometry = Shape(PlaneShape{}),
          .material = material};
}

// Over the views the mean of irradiance is N / R^2. The integrand is 2 (1 - u): midpoints are
// exact, but for cos^-3 = 1 + 1.5 t^2, whose mean weight is 1.5 slope^2 / 2.
TEST(BeamLight, HasTheEnergyOfTheRangeEquation) {
  const BeamLight light{.origin = {1, 2, 3},
                        .axis = Eigen::Vector3d(0.3, -0.2, 0.8).normalized(),
                        .slope = 0.01,
                        .electrons_at_1m = 700};
  double mean = 0;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 10; ++j)
      mean += light.irradiance(light.view({(i + 0.5) / 100, (j + 0.5) / 10}), 5) / 1000;
  EXPECT_NEAR(mean / (700 / 25.0), 1, 1e-4);
}

// Its integral over the sphere is the flux, by midpoints in tangents up to 5 slopes: exp(-25) lies
// beyond, and the trapezoidal sum of a Gaussian over so many steps is exact.
TEST(BeamLight, ShinesItsFlux) {
  const BeamLight light{
      .origin = {0, 0, 0}, .axis = Eigen::Vector3d::UnitZ(), .slope = 0.02, .electrons_at_1m = 3};
  double flux = 0;
  const double step = 10 * light.slope / 200;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j) {
      const Eigen::Vector3d direction =
          Eigen::Vector3d((i - 99.5) * step, (j - 99.5) * step, 1).normalized();
      flux += light.irradiance(direction, 7) * 49 * step * step * std::pow(direction.z(), 3);
    }
  EXPECT_NEAR(flux / light.flux(), 1, 1e-9);
}

// Samples come with the density irradiance / flux: their mean square tangent is slope^2. Midpoints
// of the logarithm's last cell miss up to 1 / 100 of its share, 6 %.
TEST(BeamLight, IsSampledAsItShines) {
  const BeamLight light{
      .origin = {0, 0, 0}, .axis = Eigen::Vector3d::UnitZ(), .slope = 0.02, .electrons_at_1m = 3};
  double square = 0;
  for (int i = 0; i < 1000; ++i) {
    const EmittedRay ray = light.sample({(i + 0.5) / 1000, 0.3});
    EXPECT_EQ(ray.flux, light.flux());
    square += (ray.direction.head<2>() / ray.direction.z()).squaredNorm() / 1000;
  }
  EXPECT_NEAR(square / (light.slope * light.slope), 1, 1e-3);
}

// A ray across the beam meets it where the axis is; there the beam is slope times the distance
// wide.
TEST(BeamLight, IsBrightestAtItsAxis) {
  const BeamLight light{
      .origin = {0, 0, 0}, .axis = Eigen::Vector3d::UnitZ(), .slope = 0.02, .electrons_at_1m = 3};
  const Brightest across = light.brightest({4, 0, 10}, {-1, 0, 0});
  EXPECT_NEAR(across.distance_m, 4, 1e-12);
  EXPECT_NEAR(across.half_width_m, 0.2, 1e-12);
  const Brightest away = light.brightest({4, 0, 10}, {1, 0, 0});
  EXPECT_EQ(away.distance_m, 0);
  EXPECT_NEAR(away.half_width_m, std::hypot(4, 0.2), 1e-12);
  EXPECT_GT(light.brightest({0, 0, 0}, {0, 0, 1}).half_width_m, 0);
}

// Over a mirror at 45 degrees, 5 m away, to a wall 3 m from it: one echo at 8 m whose energy is the
// range equation's times the reflectance twice.
TEST(LidarPaths, SeeAGhostOverAMirror) {
  const Conductor metal{.eta = 1.2, .k = 6, .roughness = 0};
  const double pi = std::numbers::pi;
  Scene scene{.objects = {turned_plane(5, pi + pi / 4, 0)},
              .materials = {{.name = "mirror", .bsdf = metal}, plain(0.6)}};
  // the mirror's normal halves the angle between -z and the way on
  const Eigen::Vector3d normal =
      scene.objects[0].world_from_object.linear() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d on = Eigen::Vector3d::UnitZ() - 2 * normal.z() * normal;
  Object wall = plane_at(0, 0, 1);
  wall.world_from_object = make_pose(
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -on).toRotationMatrix(),
      Eigen::Vector3d(0, 0, 5) + 3 * on);
  scene.objects.push_back(wall);
  const PulsedLidar lidar = wide_beam();
  const Moments ghost = moments_of(lidar, path_waveform(lidar, scene));
  const double reflectance = fresnel_conductor(std::cos(pi / 4), metal.eta, metal.k);
  const double expected_e = 5000 * 0.6 * 100 / 64 * reflectance * reflectance;
  // paths stop at a fifth of the reading's noise, of some 30 readings: 0.2 / sqrt(N) of the sum
  EXPECT_NEAR(ghost.electrons / expected_e, 1, 3 * 0.2 / std::sqrt(expected_e) + 1e-3);
  EXPECT_NEAR(ghost.time_s * c / 2, 8, 1e-3);
}

// Without mirrors' effect the ghost is not there; nor is there anything else.
TEST(LidarPaths, EndAtAMirrorThatIsOff) {
  Scene scene{.objects = {turned_plane(5, std::numbers::pi, 0)},
              .materials = {{.name = "mirror", .bsdf = Conductor{.roughness = 0}}, plain(0.6)}};
  scene.objects.push_back(plane_at(9, 0, 1));
  const auto samples =
      path_waveform(wide_beam(), scene, light_effects.without(Effect::mirror_reflection));
  for (const double sample : samples) EXPECT_EQ(sample, 0);
}

// A pane of d = 0.1 m and n = 1.5 before a wall at 10 m: the first echo comes d (n - 1) = 50 mm
// late; with all internal reflections both ways 0.8521 of the energy (physics 7.6), of which
// (1 - r)^4 = 0.8493 comes first, r = 0.04; the next, 2 r^2 of it, 2 d n later.
TEST(LidarPaths, AreDelayedByAPane) {
  Object pane{.name = "pane",
              .world_from_object = make_pose(Eigen::Matrix3d::Identity(), {0, 0, 5}),
              .geometry = Shape(BoxShape{{4, 4, 0.1}}),
              .material = 1};
  const Scene scene{.objects = {plane_at(10), pane},
                    .materials = {plain(0.5), {.name = "glass", .bsdf = Dielectric{1.5}}}};
  PulsedLidar lidar = wide_beam();
  lidar.divergence_rad = 1e-4;
  const Moments echo = moments_of(lidar, path_waveform(lidar, scene));
  // The pane brings the wall optically nearer by d (1 - 1 / n): (10 / 9.967)^2 more. Paths stop at
  // a fifth of the reading's noise, judged by four streams: three times 0.2 / sqrt(2000) of the
  // sum.
  const double nearer = std::pow(10 / (10 - 0.1 / 3), 2);
  EXPECT_NEAR(echo.electrons / 2500, 0.8521 * nearer, 0.02);
  // The mean of all: 2 r^2 (0.0032) of it on either way by 2 d n / 2 = 0.15 m more.
  EXPECT_NEAR(echo.time_s * c / 2, 10.05, 2e-3);
}

// In a sphere of albedo rho the light of k extra bounces is spread evenly, irradiance rho^k flux /
// (4 pi r^2) (the integrating sphere): the waveform gains rho^(k + 1) N view^2 / (4 r^2), view =
// view_radii slope, for k = 1 to 7.
TEST(LidarPaths, FillAnIntegratingSphere) {
  const double radius_m = 2, albedo = 0.5;
  Scene scene = scene_of(sphere_at({0, 0, 0}, radius_m), albedo);
  PulsedLidar lidar = wide_beam();
  lidar.divergence_rad = 0.1;
  lidar.electrons_at_10m = 1e4;
  lidar.max_range_m = 40;
  const double slope = std::tan(0.05);
  double expected_e = 0;
  for (int k = 1; k <= 7; ++k)
    expected_e += std::pow(albedo, k + 1) * 1e6 * slope * slope / (2 * radius_m * radius_m);
  const auto samples = path_waveform(lidar, scene);
  const double sum_e = std::accumulate(samples.begin(), samples.end(), 0.0);
  // 0.2 of the noise in each of some 100 readings, sqrt(expected) in all, three times.
  EXPECT_NEAR(sum_e / expected_e, 1, 3 * 0.2 / std::sqrt(expected_e));
  // Nothing comes before the second bounce could: 2 r + a chord, and 9 sigma before.
  const SampleAxis axis = sample_axis(lidar);
  const double first_s = 2 * radius_m / c - 9 * lidar.pulse_sigma_s;
  const auto before = static_cast<std::ptrdiff_t>((first_s - axis.start_s) / axis.interval_s);
  if (before > 0) {
    EXPECT_EQ(std::accumulate(samples.begin(), samples.begin() + before, 0.0), 0);
  }
}

// An environment of radiance 1: a white wall under pi W / m^2 sends pi electrons_per_w_m2, and half
// as much at albedo 0.5, into every sample.
TEST(LidarPaths, AddTheScenesLightToEverySample) {
  Scene scene = scene_of(plane_at(10), 0.5);
  scene.lights = {Environment{.radiance_w_m2_sr = 1}};
  PulsedLidar lidar = wide_beam();
  lidar.electrons_per_w_m2 = 20;
  const auto samples = path_waveform(lidar, scene);
  const double expected_e = std::numbers::pi * 20 * 0.5;
  EXPECT_NEAR(samples[10], expected_e, 3 * 0.2 * std::sqrt(expected_e));
  EXPECT_EQ(samples[10], samples[samples.size() - 10]);
}

// No paths, nothing to say; with them their number and how far they got: at least 16 a pulse, their
// errors on the average below the goal of a fifth of the noise.
TEST(LidarPaths, SayWhatTheyCost) {
  PulsedLidar lidar = wide_beam();
  lidar.pattern = RasterPattern{.rows = 4, .columns = 5, .height_rad = 0.01, .width_rad = 0.01};
  const Scene scene = scene_of(sphere_at({0, 0, 0}, 2), 0.5);
  const RayCaster caster(scene);
  const RenderStatistics off =
      render(lidar, caster, Pose::Identity(), {}, {Effect::footprint}).statistics;
  EXPECT_EQ(off.paths, 0u);
  EXPECT_EQ(off.sampling_error_max, 0);
  const RenderStatistics on =
      render(lidar, caster, Pose::Identity(), {}, {Effect::interreflection, Effect::footprint})
          .statistics;
  EXPECT_GE(on.paths, 16u * 20u);
  EXPECT_GT(on.sampling_error_rms, 0);
  EXPECT_LE(on.sampling_error_rms, 0.2);
  EXPECT_GE(on.sampling_error_max, on.sampling_error_rms);
}

// The same bytes with paths as well.
TEST(LidarPaths, AreTheSameForAnyThreadCount) {
  PulsedLidar lidar = wide_beam();
  const Scene scene = scene_of(sphere_at({0, 0, 0}, 2), 0.5);
  expect_same_for_any_thread_count([&] {
    const Rendering rendering =
        render(lidar, RayCaster(scene), Pose::Identity(), {.seed = 3, .scan = 1}, light_effects);
    auto samples = std::get<Waveforms>(rendering.frames).samples;
    samples.push_back(static_cast<std::uint16_t>(rendering.statistics.paths));
    return samples;
  });
}

// What is known in closed form is left to it: a lone convex body has no other light.
TEST(LidarPaths, AddNothingToALoneWall) {
  for (const double sample : path_waveform(wide_beam(), scene_of(plane_at(10, 0.5), 0.9)))
    EXPECT_EQ(sample, 0);
}

TEST(LidarPaths, AreNeededOnlyWhereLightBendsOrGoesOn) {
  const PulsedLidar lidar = wide_beam();
  const Scene matt = scene_of(plane_at(10), 0.5);
  EXPECT_FALSE(LidarPaths::needed(lidar, matt, light_effects.without(Effect::interreflection)));
  EXPECT_TRUE(LidarPaths::needed(lidar, matt, light_effects));
  Scene mirror = matt;
  mirror.materials[0].bsdf = Conductor{.roughness = 0};
  EXPECT_TRUE(LidarPaths::needed(lidar, mirror, {Effect::mirror_reflection}));
  EXPECT_FALSE(LidarPaths::needed(lidar, mirror, {Effect::footprint}));
}

}  // namespace
}  // namespace scan::synth
