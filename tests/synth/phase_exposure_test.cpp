// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_exposure.h"

#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

// The camera of one pixel, of 80 and 120 MHz, that moves; its taps without noise.
PhaseTaps moving_taps(const Eigen::Vector3d& velocity_m_s, const Eigen::Vector3d& turn_rad_s) {
  PhaseCamera camera = one_pixel();
  camera.frequencies_hz = {80e6, 120e6};
  camera.tap_interval_s = 1e-3;
  camera.velocity_m_s = velocity_m_s;
  camera.angular_velocity_rad_s = turn_rad_s;
  camera.ambient_electrons = 1000;
  const Scene scene{.objects = {plane_at(1.2)}, .materials = {plain(0.5)}};
  return taps_of(camera, scene, {Effect::quantisation, Effect::motion});
}

// Tap k of frequency f at distance d, the light's cosine at the plane given.
double expected_tap(double frequency_hz, int tap, double d, double cosine) {
  const double own = 20000 * 0.5 * cosine / (d * d);
  return own * (1 + 0.5 * std::cos(phase_of(frequency_hz, d) + tap * std::numbers::pi / 2)) +
         0.5 * 1000;
}

// Time of tap k of frequency f of the eight, their middle at 0.
double time_s(int frequency, int tap) {
  return (4 * frequency + tap - 3.5) * 1e-3;
}

// At 3 m/s along the axis the plane is 3 t nearer. Rounding: half a DN of one electron.
TEST(PhaseExposure, SeesAPlaneNearerFromTapToTap) {
  const PhaseTaps frames = moving_taps({0, 0, 3}, {0, 0, 0});
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(frames.taps[f][k].pixels[0],
                  expected_tap(f == 0 ? 80e6 : 120e6, k, 1.2 - 3 * time_s(f, k), 1), 0.5 + 1e-6);
}

// Turned by a = 40 t rad about y the axis meets the plane at 1.2 / cos a, with the cosine cos a.
TEST(PhaseExposure, TurnsBetweenTaps) {
  const PhaseTaps frames = moving_taps({0, 0, 0}, {0, 40, 0});
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k) {
      const double cosine = std::cos(40 * time_s(f, k));
      EXPECT_NEAR(frames.taps[f][k].pixels[0],
                  expected_tap(f == 0 ? 80e6 : 120e6, k, 1.2 / cosine, cosine), 0.5 + 1e-6);
    }
}

TEST(PhaseExposure, IsOneForAllTapsOfAStillScanner) {
  PhaseCamera camera = small_camera();
  EXPECT_EQ(exposures_of(camera).size(), 1u);
  camera.tap_interval_s = 1e-3;
  EXPECT_EQ(exposures_of(camera).size(), 1u);
  camera.velocity_m_s = {0.1, 0, 0};
  EXPECT_EQ(exposures_of(camera).size(), 12u);
}

LightImage light_of(const PhaseCamera& camera, const Scene& scene) {
  return direct_light(camera, tones_of(camera), RayCaster(scene), Pose::Identity(),
                      {0, camera.camera.height_px});
}

// Expects each pixel's light to be that of all its sub-rays to within `turning` (across a phasor)
// and `brightness` of a tap's noise and the rounding of their sum.
void expect_mean_light(const PhaseCamera& camera, const Scene& scene, double turning,
                       double brightness) {
  LightImage light = light_of(camera, scene);
  const int width = camera.camera.width_px;
  for (std::size_t i = 0; i < light.constant_e.size(); ++i) {
    const auto [column, row] = place_of(i, width);
    const PixelPhasors full = light_at(camera, scene, column, row);
    const double noise_e = std::sqrt(tap_variance_e2(camera.sensor, full.constant_e));
    const double rounding_e = 1e-12 * 20000;
    EXPECT_NEAR(light.constant_e[i], full.constant_e, brightness * noise_e + rounding_e);
    for (std::size_t t = 0; t < light.tones; ++t) {
      const Phasor found = light.at(i).amplitude_e[t];
      const Phasor off =
          (found - full.amplitude_e[t]) * std::conj(found) / std::max(1e-300, std::abs(found));
      EXPECT_LE(std::abs(off.imag()), turning * noise_e + rounding_e) << column << ' ' << row;
      EXPECT_LE(std::abs(off.real()), brightness * noise_e + rounding_e) << column << ' ' << row;
    }
  }
}

// Steps, creases, curved rims, the void and a shadow's edge.
TEST(SubRays, MayBeLeftOutWhereThatIsSmallBesideTheNoise) {
  PhaseCamera camera = small_camera();
  camera.sub_rays = 4;
  camera.emitter_offset_m = 0.05;
  camera.ambient_electrons = 500;
  const Scene scene{.objects = {plane_at(2, 0.5), plane_at(1.7, -0.6, 1), plate(1, -0.25, 0.13),
                                sphere_at({0.3, 0.1, 0.9}, 0.15, 1)},
                    .materials = {plain(0.5), plain(0.7)}};
  expect_mean_light(camera, scene, 0.05, 0.5);
  const Scene lonely{.objects = {sphere_at({0.01, 0.02, 1}, 0.2)}, .materials = {plain(0.6)}};
  expect_mean_light(camera, lonely, 0.05, 0.5);
}

// Low steps, whose edge stands at any place in its pixel.
TEST(SubRays, AreThereForLowSteps) {
  PhaseCamera camera = small_camera();
  camera.camera.fx_px = camera.camera.fy_px = 365;
  camera.camera.width_px = 12;
  camera.camera.height_px = 3;
  camera.sub_rays = 5;
  for (const double step_m : {0.001, 0.003, 0.01, 0.03})
    for (const double edge_px : {5.1, 5.25, 5.4, 5.7}) {
      const double z_m = 1.5 - step_m;
      const double edge_m = (edge_px - camera.camera.cx_px) / 365 * z_m;
      const Scene scene{.objects = {plane_at(1.5), plate(z_m, -1, edge_m)},
                        .materials = {plain(0.5)}};
      expect_mean_light(camera, scene, 0.05, 0.5);
    }
}

// A texture finer than a pixel may show the same shade at all centres.
TEST(SubRays, AreAllThereOnTextures) {
  PhaseCamera camera = small_camera();
  camera.sub_rays = 3;
  Scene scene{.objects = {plane_at(1)}, .materials = {plain(0.5)}};
  scene.materials[0].texture = CheckerTexture{.period_m = 1.0 / 60, .contrast = 1};
  EXPECT_EQ(light_of(camera, scene).refined_pixels, 48u * 32u);
  expect_mean_light(camera, scene, 0, 0);
}

// Pixels as wide as those of a camera on the market (365 px of focal length).
TEST(SubRays, CostNothingOnASmoothSurface) {
  PhaseCamera camera = small_camera();
  camera.camera.fx_px = camera.camera.fy_px = 365;
  camera.sub_rays = 4;
  const Scene scene{.objects = {plane_at(2, 0.5)}, .materials = {plain(0.5)}};
  EXPECT_EQ(light_of(camera, scene).refined_pixels, 0u);
  // Of a plate's two edges the pixels on either side, and near the ends of the image no more.
  const Scene edges{.objects = {plane_at(2), plate(1, -0.02, 0.02)}, .materials = {plain(0.5)}};
  EXPECT_EQ(light_of(camera, edges).refined_pixels, 2u * 2u * 32u);
}

}  // namespace
}  // namespace scan::synth
