// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_camera.h"

#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

// Distance from the origin along a unit direction to plane_at(z_m, tilt_rad).
double distance_to_plane(const Eigen::Vector3d& direction, double z_m, double tilt_rad) {
  const Eigen::Vector3d normal(-std::sin(tilt_rad), 0, -std::cos(tilt_rad));
  return normal.z() * z_m / normal.dot(direction);
}

TEST(PhaseCamera, CarriesTheDistanceAlongTheRayInItsPhase) {
  const PhaseCamera camera = small_camera();
  const double tilt_rad = 0.6;
  const Scene scene{.objects = {plane_at(2, tilt_rad)}, .materials = {plain(0.5)}};
  for (const auto& [column, row] : {std::pair(0, 0), std::pair(24, 16), std::pair(47, 5)}) {
    const double d = distance_to_plane(direction_of(camera, column, row), 2, tilt_rad);
    const PixelPhasors light = light_at(camera, scene, column, row);
    for (std::size_t f = 0; f < 3; ++f)
      EXPECT_LT(angle_between(light.amplitude_e[f], phase_of(camera.frequencies_hz[f], d)), 1e-9);
  }
}

// B = electrons_at_1m albedo cos / R^2 + ambient albedo, A = contrast times the first part.
TEST(PhaseCamera, ReceivesLightByAlbedoCosineAndInverseSquare) {
  PhaseCamera camera = small_camera();
  camera.contrast = 0.4;
  camera.ambient_electrons = 700;
  const double tilt_rad = -0.5;
  const Scene scene{.objects = {plane_at(3, tilt_rad)}, .materials = {plain(0.25)}};
  const Eigen::Vector3d direction = direction_of(camera, 40, 3);
  const double d = distance_to_plane(direction, 3, tilt_rad);
  const double cosine = Eigen::Vector3d(std::sin(tilt_rad), 0, std::cos(tilt_rad)).dot(direction);
  const double own = 20000 * 0.25 * cosine / (d * d);
  const PixelPhasors light = light_at(camera, scene, 40, 3);
  EXPECT_NEAR(light.constant_e, own + 700 * 0.25, 1e-9 * own);
  EXPECT_NEAR(std::abs(light.amplitude_e[1]), 0.4 * own, 1e-9 * own);
}

// Rounding moves each tap by at most 1/2 DN, so C0 - C2 and C3 - C1 by at most 1: the phasor of
// length 2 A / gain turns by at most asin(sqrt(2) gain / (2 A)).
TEST(PhaseCamera, WritesTapsThatDecodeToThePhaseButForRounding) {
  PhaseCamera camera = small_camera();
  camera.sensor.offset_dn = 100;
  camera.sensor.gain_e_per_dn = 4;
  const Scene scene{.objects = {plane_at(1.3, 0.3)}, .materials = {plain(0.8)}};
  const PhaseTaps frames = taps_of(camera, scene, noise_free);
  ASSERT_EQ(frames.taps.size(), 3u);
  EXPECT_EQ(frames.calibration.frequencies_hz, camera.frequencies_hz);
  for (std::size_t pixel = 0; pixel < 48 * 32; ++pixel) {
    const int column = static_cast<int>(pixel % 48), row = static_cast<int>(pixel / 48);
    const double d = distance_to_plane(direction_of(camera, column, row), 1.3, 0.3);
    for (std::size_t f = 0; f < 3; ++f) {
      const double amplitude_e = std::abs(light_at(camera, scene, column, row).amplitude_e[f]);
      const double bound = std::asin(std::sqrt(2) * 4 / (2 * amplitude_e));
      EXPECT_LE(angle_between(decode(frames, f, pixel), phase_of(camera.frequencies_hz[f], d)),
                bound);
    }
  }
}

// Lange's law, sigma_d = c / (4 sqrt(2) pi f) sqrt(B) / A: 9.430 mm for f 80 MHz, A 1000, B 2000
// (physics 7.5). A field of 1e-4 rad holds the distance to 1e-8 m. (n - 1) s^2 / sigma^2 is
// chi-square with the deviation sqrt(2 n); for n = 1e4 five of them are 3.5 % of s. The law is
// linear in the noise; the next order is sigma_phi^2 = 1e-3 of it. Mean: five standard errors.
TEST(PhaseCamera, ScattersByTheShotNoiseLaw) {
  PhaseCamera camera = small_camera();
  camera.camera = {
      .width_px = 100, .height_px = 100, .fx_px = 1e6, .fy_px = 1e6, .cx_px = 49.5, .cy_px = 49.5};
  camera.frequencies_hz = {80e6};
  camera.electrons_at_1m = 2000;
  const Scene scene{.objects = {plane_at(1)}, .materials = {plain(1)}};
  const PhaseTaps frames = taps_of(camera, scene, sensor_effects, {.seed = 11, .scan = 3});
  const double law_m =
      speed_of_light_m_s / (4 * std::sqrt(2) * std::numbers::pi * 80e6) * std::sqrt(2000) / 1000;
  EXPECT_NEAR(law_m, 9.430e-3, 1e-6);
  double sum = 0, sum2 = 0;
  const int count = 100 * 100;
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    const double turned = std::arg(decode(frames, 0, pixel) * std::polar(1.0, -phase_of(80e6, 1)));
    const double error_m = turned / phase_of(80e6, 1);
    sum += error_m;
    sum2 += error_m * error_m;
  }
  const double mean_m = sum / count;
  const double sigma_m = std::sqrt((sum2 - count * mean_m * mean_m) / (count - 1));
  EXPECT_NEAR(sigma_m / law_m, 1, 5 / std::sqrt(2.0 * count) + 1e-3);
  EXPECT_NEAR(mean_m, 0, 5 * law_m / std::sqrt(count));
}

// A plate in front hides the light, 0.2 m to the right of the lens, from a strip of the plane that
// the lens sees: beside its left edge x_e, as far as the projection of the light, x_e 2/1 - 0.2.
TEST(PhaseCamera, CastsTheShadowOfItsOwnLight) {
  PhaseCamera camera = small_camera();
  camera.emitter_offset_m = 0.2;
  camera.ambient_electrons = 500;
  const Scene scene{.objects = {plane_at(2), plate(1, 0.1, 0.9)}, .materials = {plain(0.6)}};
  for (int column = 0; column < camera.camera.width_px; ++column) {
    const double x_m = 2 * (column - 23.5) / 60;  // on the plane
    if (x_m >= 0.2) break;                        // behind the plate
    const PixelPhasors light = light_at(camera, scene, column, 16);
    const bool dark = x_m > 2 * 0.1 - 0.2;
    EXPECT_EQ(std::abs(light.amplitude_e[0]) == 0, dark) << "column " << column;
    if (dark) {
      EXPECT_DOUBLE_EQ(light.constant_e, 0.6 * 500);
    }
  }
}

// The phase counts (|light - x| + |x|) / 2. Expanding |light - x| = R sqrt(1 - 2 b u / R + b^2 /
// R^2) the bias is -b u / 2 within b^2 / (4 R).
TEST(PhaseCamera, CountsTheTruePathFromItsOffsetLight) {
  PhaseCamera camera = small_camera();
  camera.emitter_offset_m = 0.03;
  const Scene scene{.objects = {plane_at(2)}, .materials = {plain(0.6)}};
  for (const int column : {0, 20, 47}) {
    const Eigen::Vector3d direction = direction_of(camera, column, 10);
    const double d = distance_to_plane(direction, 2, 0);
    const double path_m = (d * direction - Eigen::Vector3d(0.03, 0, 0)).norm() + d;
    const Phasor phasor = light_at(camera, scene, column, 10).amplitude_e[1];
    EXPECT_LT(angle_between(phasor, phase_of(80e6, path_m / 2)), 1e-9);
    EXPECT_LE(std::abs(path_m / 2 - d + 0.03 / 2 * direction.x()), 0.03 * 0.03 / (4 * d));
  }
}

// A pixel that looks half at a near and half at a far surface adds their phasors; its distance is
// neither of the two, nor their mean.
TEST(PhaseCamera, MixesSurfacesInsideAPixelAsPhasors) {
  PhaseCamera camera = small_camera();
  camera.sub_rays = 2;
  camera.frequencies_hz = {80e6};
  const auto scene = [](bool near_plate, bool far_plane) {
    Scene s{.objects = {}, .materials = {plain(0.6)}};
    if (far_plane) s.objects.push_back(plane_at(1.5));
    if (near_plate) s.objects.push_back(plate(1, -0.9, (30 - 23.5) / 60.0));  // ends at column 30
    return s;
  };
  const PixelPhasors both = light_at(camera, scene(true, true), 30, 16);
  const PixelPhasors near_only = light_at(camera, scene(true, false), 30, 16);
  const PixelPhasors far_all = light_at(camera, scene(false, true), 30, 16);
  const PixelPhasors far_left = light_at(camera, scene(false, true), 29, 16);
  // The far half is what pixel 30 sees of the plane less its left half, which the plate hides. Left
  // and right half differ by the ray's slope, half of what the neighbour differs.
  const Phasor far_half = both.amplitude_e[0] - near_only.amplitude_e[0];
  const double slope = std::abs(far_all.amplitude_e[0] - far_left.amplitude_e[0]);
  EXPECT_LT(std::abs(far_half - 0.5 * far_all.amplitude_e[0]), slope);
  EXPECT_NEAR(std::abs(near_only.amplitude_e[0]) / std::abs(far_half), 2.25, 0.05);  // (1.5 / 1)^2
}

// Ranges that a warm camera with a fixed pattern reads, less the true ones: pixel by pixel.
std::vector<double> offsets_m(std::uint32_t scan) {
  PhaseCamera camera = small_camera();
  camera.electrons_at_1m = 40000;
  camera.range_offset_m = 0.02;
  camera.pixel_offset_m = 0.005;
  const Scene scene{.objects = {plane_at(1)}, .materials = {plain(1)}};
  const PhaseTaps frames = taps_of(camera, scene, {Effect::quantisation, Effect::miscalibration},
                                   {.seed = 5, .scan = scan});
  std::vector<double> offsets;
  for (std::size_t pixel = 0; pixel < 48 * 32; ++pixel) {
    const PixelPlace place = place_of(pixel, 48);
    const double true_m = 1 / direction_of(camera, place.column, place.row).z();
    const Phasor turned = decode(frames, 1, pixel) * std::polar(1.0, -phase_of(80e6, true_m));
    offsets.push_back(std::arg(turned) / phase_of(80e6, 1));
  }
  return offsets;
}

// Mean and deviation of 1536 normal offsets: five standard errors; rounding of 1/2 e of 1e4 and
// more is 0.02 mm.
TEST(PhaseCamera, AddsItsOffsetAndAFixedPatternToAllRanges) {
  const std::vector<double> offsets = offsets_m(0);
  const auto count = static_cast<double>(offsets.size());
  double mean = 0, square = 0;
  for (const double offset : offsets) mean += offset / count;
  for (const double offset : offsets) square += (offset - mean) * (offset - mean) / (count - 1);
  EXPECT_NEAR(mean, 0.02, 5 * 0.005 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(square), 0.005, 5 * 0.005 / std::sqrt(2 * count) + 2e-5);
  const std::vector<double> later = offsets_m(1);
  for (std::size_t i = 0; i < offsets.size(); ++i) EXPECT_NEAR(offsets[i], later[i], 1e-12);
}

TEST(PhaseCamera, IsIdealWithoutEffects) {
  PhaseCamera camera = small_camera();
  const Scene scene{.objects = {plane_at(1.5), plate(1, -0.1, 0.1)}, .materials = {plain(0.6)}};
  const auto ideal = taps_of(camera, scene, {}).taps;
  camera.harmonics = {0.1, 0.1};
  camera.tap_interval_s = 1e-3;
  camera.velocity_m_s = {1, 1, 1};
  camera.vignetting = 1;
  camera.aperture_m = 0.02;
  camera.range_offset_m = 0.1;
  camera.pixel_offset_m = 0.1;
  camera.sub_rays = 4;
  camera.sensor.read_noise_e = 100;
  const auto bare = taps_of(camera, scene, {}).taps;
  for (std::size_t f = 0; f < ideal.size(); ++f)
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(ideal[f][k].pixels, bare[f][k].pixels);
  for (const Effect effect : {Effect::wiggling, Effect::motion, Effect::vignetting, Effect::defocus,
                              Effect::miscalibration, Effect::footprint, Effect::read_noise})
    EXPECT_NE(taps_of(camera, scene, {effect}).taps[0][1].pixels, ideal[0][1].pixels)
        << name(effect);
}

TEST(PhaseCamera, KnowsWhereItsPixelsLookThroughADistortedLens) {
  PhaseCamera camera = small_camera();
  camera.camera.k1 = -0.2;
  const Scene scene{.objects = {plane_at(1.5)}, .materials = {plain(0.6)}};
  const auto rays = true_rays(camera, RayCaster(scene), Pose::Identity());
  for (std::size_t i = 0; i < rays.size(); i += 37) {
    const auto pixel = project(camera.camera, rays[i].point_in_scanner);
    EXPECT_NEAR(rays[i].point_in_scanner.z(), 1.5, 1e-12);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x(), static_cast<double>(i % 48), 1e-9);
    EXPECT_NEAR(pixel->y(), static_cast<double>(i / 48), 1e-9);
    const PixelPhasors light =
        light_at(camera, scene, static_cast<int>(i % 48), static_cast<int>(i / 48));
    EXPECT_LT(angle_between(light.amplitude_e[0], phase_of(16e6, rays[i].point_in_scanner.norm())),
              1e-9);
  }
}

TEST(PhaseCamera, RendersTheSameBytesForAnyThreadCount) {
  PhaseCamera camera = small_camera();
  camera.sub_rays = 2;
  camera.emitter_offset_m = 0.02;
  const Scene scene{.objects = {sphere_at({0, 0, 1}, 0.3)}, .materials = {plain(0.7)}};
  expect_same_for_any_thread_count([&] {
    std::vector<std::uint16_t> all;
    for (const auto& set : taps_of(camera, scene, sensor_effects, {.seed = 9, .scan = 4}).taps)
      for (const auto& tap : set) all.insert(all.end(), tap.pixels.begin(), tap.pixels.end());
    return all;
  });
}

// Two taps of one mean differ by their noise alone: with 2.5e3 e and more they agree in few pixels.
TEST(PhaseCamera, GivesEachTapNoiseOfItsOwn) {
  PhaseCamera camera = small_camera();
  camera.contrast = 0;
  const Scene scene{.objects = {plane_at(1)}, .materials = {plain(0.7)}};
  const PhaseTaps frames = taps_of(camera, scene, sensor_effects);
  EXPECT_NE(frames.taps[0][0].pixels, frames.taps[0][1].pixels);
  EXPECT_NE(frames.taps[0][0].pixels, frames.taps[1][0].pixels);
}

}  // namespace
}  // namespace scan::synth
