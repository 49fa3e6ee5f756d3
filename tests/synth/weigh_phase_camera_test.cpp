// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Each bound against the error that leaving the effect out makes, on scenes built to come near it.
#include <algorithm>

#include "synth/effects/weight.h"
#include "synth/scanners/phase_paths.h"
#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

// 32 x 24 px; 365 px of focal length.
PhaseCamera camera_of(std::vector<double> frequencies_hz) {
  PhaseCamera camera;
  camera.camera = {
      .width_px = 32, .height_px = 24, .fx_px = 365, .fy_px = 365, .cx_px = 15.5, .cy_px = 11.5};
  camera.frequencies_hz = std::move(frequencies_hz);
  camera.sensor.gain_e_per_dn = 0.25;
  return camera;
}

Weight weight_of(const PhaseCamera& camera, const Scene& scene, Effect effect) {
  const auto rays = pilot(camera, RayCaster(scene), Pose::Identity(), 32 * 24);
  EXPECT_EQ(rays.size(), 32u * 24u);
  const Weighed weighed = weigh(camera, scene, effect, rays);
  EXPECT_TRUE(weighed.weight) << weighed.why_absent;
  return weighed.weight.value_or(Weight{});
}

// Largest range by which the effect moves a pixel, the frequencies weighed as the decoder weighs
// them.
double largest_change_m(const PhaseCamera& camera, const Scene& scene, Effect effect) {
  const PhaseTaps with = taps_of(camera, scene, {effect});
  const PhaseTaps without = taps_of(camera, scene, {});
  double largest = 0;
  for (std::size_t pixel = 0; pixel < with.taps[0][0].pixels.size(); ++pixel) {
    double sum = 0, weights = 0;
    for (std::size_t f = 0; f < camera.frequencies_hz.size(); ++f) {
      const double k = phase_of(camera.frequencies_hz[f], 1);
      sum += k * std::arg(decode(with, f, pixel) * std::conj(decode(without, f, pixel)));
      weights += k * k;
    }
    largest = std::max(largest, std::abs(sum / weights));
  }
  return largest;
}

// Steps of 1/4 e turn phasors of 900 e and more by sqrt(2) / 4 / 2 / 900 rad at most, with and
// without the effect: 0.12 mm at 80 MHz.
constexpr double rounding_m = 1.2e-4;

// The bound holds and is no more than ten times what is reached.
void expect_bound(const PhaseCamera& camera, const Scene& scene, Effect effect) {
  const double bound_m = weight_of(camera, scene, effect).bound_m;
  const double reached_m = largest_change_m(camera, scene, effect);
  std::printf("bound: %-24s %9.4g mm, error %.4g mm, %.2f of it\n",
              std::string(name(effect)).c_str(), bound_m * 1e3, reached_m * 1e3,
              reached_m / bound_m);
  EXPECT_LE(reached_m, bound_m + rounding_m) << name(effect);
  EXPECT_GE(reached_m, bound_m / 10) << name(effect);
}

Scene plane_scene(double z_m = 1.5, double tilt_rad = 0.4) {
  return {.objects = {plane_at(z_m, tilt_rad)}, .materials = {plain(0.6)}};
}

TEST(WeighPhaseCamera, BoundsWiggling) {
  PhaseCamera camera = camera_of({80e6});
  camera.harmonics = {0, 0.03, 0, -0.01};
  expect_bound(camera, plane_scene(1.5, 1.1), Effect::wiggling);
}

TEST(WeighPhaseCamera, BoundsMiscalibration) {
  PhaseCamera camera = camera_of({16e6, 80e6, 120e6});
  camera.range_offset_m = 0.01;
  camera.pixel_offset_m = 0.002;
  // The largest of 768 normal offsets is above three sigmas with a chance of 1 - 0.99865^768.
  const Weight weight = weight_of(camera, plane_scene(), Effect::miscalibration);
  EXPECT_DOUBLE_EQ(weight.bound_m, 0.016);
  EXPECT_NEAR(largest_change_m(camera, plane_scene(), Effect::miscalibration), 0.016, 0.004);
}

// Shift, ripple and change of brightness add up at some distances and cancel at others.
TEST(WeighPhaseCamera, BoundsMotion) {
  for (const auto& frequencies : {std::vector{80e6}, std::vector{80e6, 120e6}}) {
    PhaseCamera camera = camera_of(frequencies);
    camera.tap_interval_s = 1e-3;
    camera.velocity_m_s = {0.4, 0, 1.6};
    camera.angular_velocity_rad_s = {0, 0.6, 0};
    double closest = 0;
    for (const double z_m : {1.0, 1.1, 1.2, 1.3, 1.4}) {
      const double bound_m = weight_of(camera, plane_scene(z_m), Effect::motion).bound_m;
      const double reached_m = largest_change_m(camera, plane_scene(z_m), Effect::motion);
      EXPECT_LE(reached_m, bound_m + rounding_m) << z_m;
      closest = std::max(closest, reached_m / bound_m);
    }
    EXPECT_GT(closest, 0.1);
  }
}

// Half of the pixels in a column see a plate's edge.
TEST(WeighPhaseCamera, BoundsMixedPixels) {
  PhaseCamera camera = camera_of({80e6});
  camera.sub_rays = 4;
  const Scene scene{.objects = {plane_at(1.4), plate(1.2, -0.9, 0.2 / 365)},
                    .materials = {plain(0.6)}};
  expect_bound(camera, scene, Effect::footprint);
}

TEST(WeighPhaseCamera, BoundsDefocus) {
  PhaseCamera camera = camera_of({80e6});
  camera.sub_rays = 6;
  camera.aperture_m = 0.01;
  camera.focus_m = 2;
  const Scene scene{.objects = {plane_at(1.4), plate(1.2, -0.9, 0.001)}, .materials = {plain(0.6)}};
  expect_bound(camera, scene, Effect::defocus);
}

// Two walls at a right angle, of albedo 0.8.
Scene corner() {
  return {.objects = {plane_at(1.5, std::numbers::pi / 4), plane_at(1.5, -std::numbers::pi / 4)},
          .materials = {plain(0.8)}};
}

// By 1024 paths a pixel: the noise of their mean is far below the effect.
TEST(WeighPhaseCamera, BoundsInterreflection) {
  PhaseCamera camera = camera_of({20e6});
  camera.camera.width_px = camera.camera.height_px = 8;
  camera.camera.cx_px = camera.camera.cy_px = 3.5;
  const Scene scene = corner();
  const RayCaster caster(scene);
  const auto rays = pilot(camera, caster, Pose::Identity(), 64);
  const double bound_m = weigh(camera, scene, Effect::interreflection, rays).weight->bound_m;
  const LightTransport transport(caster, transport_options({Effect::interreflection}, false));
  const PathView view{camera, transport, Pose::Identity(), {}, {}};
  const std::vector<Tone> tones = tones_of(camera);
  EstimateMemory memory;
  Estimate taps;
  double reached_m = 0;
  for (int i = 0; i < 8; ++i) {
    estimate_taps(view, tones, {i, i}, static_cast<std::uint64_t>(i), 0,
                  {.share_of_noise = 0, .least_samples = 1024, .most_samples = 1024}, memory, taps);
    const Phasor found(taps.mean[0] - taps.mean[2], taps.mean[3] - taps.mean[1]);
    const Phasor direct = expected_phasors(camera, caster, Pose::Identity(), i, i).amplitude_e[0];
    reached_m = std::max(reached_m, std::arg(found * std::conj(direct)) / phase_of(20e6, 1));
  }
  EXPECT_LE(reached_m, bound_m);
  EXPECT_GE(reached_m, bound_m / 10);
}

// Noise, rounding, vignetting and scene lights are weighed by sigmas: the pilot's own is that of
// Lange's law over the frequencies together.
TEST(WeighPhaseCamera, KnowsTheCamerasSigma) {
  PhaseCamera camera = camera_of({80e6, 120e6});
  camera.ambient_electrons = 3000;
  camera.sensor = {.gain_e_per_dn = 4, .read_noise_e = 20};
  const Scene scene = plane_scene(2, 0);
  const auto rays = pilot(camera, RayCaster(scene), Pose::Identity(), 32 * 24);
  const double own_e = 20000 * 0.6 / 4, tap_e2 = own_e + 3000 * 0.6 + 400 + 16 / 12.0;
  const double per_m = std::hypot(phase_of(80e6, 1), phase_of(120e6, 1));
  // at the corner of the image (0.053 rad off the axis) light is less by its cosine to the third
  for (const PilotRay& ray : rays) {
    EXPECT_NEAR(ray.sigma_m, std::sqrt(tap_e2 / 2) / (0.5 * own_e) / per_m, 5e-3 * ray.sigma_m);
    EXPECT_NEAR(ray.signal_e, own_e, 5e-3 * own_e);
    EXPECT_NEAR(ray.range_m, 2, 0.003);
  }
  const double shot_m = weigh(camera, scene, Effect::shot_noise, rays).weight->bound_m;
  const double read_m = weigh(camera, scene, Effect::read_noise, rays).weight->bound_m;
  EXPECT_NEAR(shot_m / read_m, std::sqrt((own_e + 1800) / 400), 0.01 * shot_m / read_m);
  EXPECT_NEAR(std::hypot(shot_m, read_m) / 3, rays[0].sigma_m, 5e-3 * rays[0].sigma_m);
}

// Quantisation against taps rounded to whole steps of 200 e.
TEST(WeighPhaseCamera, BoundsRounding) {
  PhaseCamera camera = camera_of({80e6});
  camera.sensor.gain_e_per_dn = 200;
  camera.sensor.bits = 10;
  const Scene scene = plane_scene();
  const double bound_m = weight_of(camera, scene, Effect::quantisation).bound_m;
  const PhaseTaps rounded = taps_of(camera, scene, {Effect::quantisation});
  double reached_m = 0;
  for (int row = 0; row < 24; ++row)
    for (int column = 0; column < 32; ++column) {
      const Phasor exact =
          expected_phasors(camera, RayCaster(scene), Pose::Identity(), column, row).amplitude_e[0];
      const Phasor read = decode(rounded, 0, static_cast<std::size_t>(row) * 32 + column);
      reached_m =
          std::max(reached_m, std::abs(std::arg(read * std::conj(exact))) / phase_of(80e6, 1));
    }
  EXPECT_LE(reached_m, bound_m);
  EXPECT_GE(reached_m, bound_m / 10);
}

// cos^4 at the image's corner takes the share s of a signal of shot noise: sigma without it is
// sqrt(s) of sigma with it.
TEST(WeighPhaseCamera, WeighsVignettingByItsNoise) {
  PhaseCamera camera = camera_of({80e6});
  camera.camera.fx_px = camera.camera.fy_px = 20;
  camera.vignetting = 1;
  const Scene scene = plane_scene(1, 0);
  const auto rays = pilot(camera, RayCaster(scene), Pose::Identity(), 32 * 24);
  const PilotRay& corner_ray = rays.front();
  const double share = std::pow(1 / Eigen::Vector3d(15.5 / 20, 11.5 / 20, 1).norm(), 4);
  EXPECT_NEAR(corner_ray.left_out_m[static_cast<std::size_t>(Effect::vignetting)],
              3 * corner_ray.sigma_m * (1 - std::sqrt(share)), 1e-3 * corner_ray.sigma_m);
}

TEST(WeighPhaseCamera, SaysWhatIsNotThere) {
  const PhaseCamera camera = camera_of({80e6});
  const Scene scene = plane_scene();
  const auto rays = pilot(camera, RayCaster(scene), Pose::Identity(), 100);
  for (const Effect effect : all_effects()) {
    const Weighed weighed = weigh(camera, scene, effect, rays);
    const bool always = effect == Effect::shot_noise || effect == Effect::quantisation ||
                        effect == Effect::interreflection;
    EXPECT_EQ(weighed.weight.has_value(), always) << name(effect);
    EXPECT_EQ(weighed.why_absent.empty(), always) << name(effect);
    if (weighed.weight) {
      EXPECT_FALSE(weighed.weight->why.empty());
    }
  }
}

// In a mirror the signal is what the mirror shows: a wall at 1 m + 1.5 m, by way of reflectances of
// 0.9 and less, and never nothing.
TEST(WeighPhaseCamera, LooksOverMirrors) {
  const PhaseCamera camera = camera_of({80e6});
  Scene scene{.objects = {plane_at(1, std::numbers::pi / 4), plane_at(0, 0, 1)},
              .materials = {{.name = "mirror", .bsdf = Conductor{.roughness = 0}, .texture = {}},
                            plain(0.5)}};
  const Eigen::AngleAxisd sideways(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
  scene.objects[1].world_from_object = make_pose(sideways.toRotationMatrix(), {-1.5, 0, 0});
  for (const PilotRay& ray : pilot(camera, RayCaster(scene), Pose::Identity(), 20)) {
    EXPECT_TRUE(ray.met_smooth);
    EXPECT_GT(ray.signal_e, 100);
    EXPECT_LT(ray.signal_e, 20000 * 0.5);
  }
}

// A mirror in view may show anything.
TEST(WeighPhaseCamera, TakesAMirrorForUnbounded) {
  const PhaseCamera camera = camera_of({80e6});
  const Scene scene{
      .objects = {plane_at(1.5)},
      .materials = {{.name = "mirror", .bsdf = Conductor{.roughness = 0}, .texture = {}}}};
  EXPECT_EQ(weight_of(camera, scene, Effect::mirror_reflection).bound_m, camera.max_range_m);
}

}  // namespace
}  // namespace scan::synth
