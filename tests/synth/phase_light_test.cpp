// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/phase_light.h"

#include <cstring>

#include "tests/synth/phase_bench.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// What four taps decode to, less the true phase.
double phase_error(const PhaseCamera& camera, double distance_m) {
  const Scene scene{.objects = {plane_at(distance_m)}, .materials = {plain(0.6)}};
  const PixelPhasors light = light_at(camera, scene, 0, 0);
  const auto tap = [&](int k) { return mean_tap(camera, light, 0, k); };
  const Phasor decoded(tap(0) - tap(2), tap(3) - tap(1));
  return std::arg(decoded * std::polar(1.0, -phase_of(camera.frequencies_hz[0], distance_m)));
}

// C0 - C2 and C3 - C1 of h_n cos(n phi + n k pi/2) are 2 h_n cos(n phi) and, for n = 3, -2 h_n
// sin(3 phi): the phasor 1 + h3 exp(-4 i phi). For n = 5 it is 1 + h5 exp(4 i phi). So the error is
// (h5 - h3) sin(4 phi) but for second order, at most (|h3| + |h5|)^2.
TEST(PhaseLight, WigglesByTheOddHarmonicsFourTimesPerWrap) {
  PhaseCamera camera = one_pixel();
  camera.harmonics = {0, -0.03, 0, 0.01};
  for (int i = 0; i < 40; ++i) {
    const double distance_m = 1 + 0.05 * i;
    const double phase = phase_of(80e6, distance_m);
    EXPECT_NEAR(phase_error(camera, distance_m), 0.04 * std::sin(4 * phase), 0.04 * 0.04);
    EXPECT_NEAR(
        phase_error(camera, distance_m),
        std::arg(1.0 + -0.03 * std::polar(1.0, -4 * phase) + 0.01 * std::polar(1.0, 4 * phase)),
        1e-12);
  }
}

// For even n cos(n phi + n k pi/2) is the same at k and k + 2: both differences are 0. The phase is
// of about 3e2 rad / 1e2, rounded in double.
TEST(PhaseLight, HidesEvenHarmonicsFromFourTaps) {
  PhaseCamera camera = one_pixel();
  camera.harmonics = {0.2, 0, 0.1};
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(phase_error(camera, 1 + 0.17 * i), 0, 1e-12);
}

TEST(PhaseLight, FallsWithTheFourthPowerOfTheCosine) {
  PhaseCamera camera = small_camera();
  camera.ambient_electrons = 300;
  const Scene scene{.objects = {plane_at(1.5)}, .materials = {plain(0.6)}};
  const PixelPhasors open = light_at(camera, scene, 45, 2);
  camera.vignetting = 1;
  const PixelPhasors shaded = light_at(camera, scene, 45, 2);
  const double share = std::pow(direction_of(camera, 45, 2).z(), 4);
  EXPECT_LT(share, 0.8);
  EXPECT_NEAR(shaded.constant_e, share * open.constant_e, 1e-12 * open.constant_e);
  for (std::size_t f = 0; f < 3; ++f)
    EXPECT_LT(std::abs(shaded.amplitude_e[f] - share * open.amplitude_e[f]),
              1e-12 * open.constant_e);
}

// Rays over the whole lens from a point in focus meet there: same point, same light, same path.
TEST(PhaseLight, IsSharpInTheFocalPlane) {
  PhaseCamera camera = one_pixel();
  const Scene scene{.objects = {plane_at(0.8, 0.4)}, .materials = {plain(0.6)}};
  const Phasor pinhole = light_at(camera, scene, 0, 0).amplitude_e[0];
  camera.sub_rays = 8;
  camera.aperture_m = 0.02;
  camera.focus_m = 0.8;
  const Phasor lens = light_at(camera, scene, 0, 0).amplitude_e[0];
  // The pixel's own extent, 0.8 m * 1e-6 / 2 off the axis at most, turns the phase by less than
  // phase_of(that) and changes light by that over 0.8 m.
  EXPECT_LT(std::abs(lens - pinhole), std::abs(pinhole) * phase_of(80e6, 0.8e-6));
}

// A plate to the left of x = 0 at z_n hides, from the point (X, 0, s) in focus, the part of the
// lens with a_x (1 - z_n / s) + X z_n / s < 0: a segment of the disk left of the chord at t = -X
// z_n / (s - z_n), in lens radii. The lens is sampled by 64^2 cells of equal area; a chord crosses
// 2 * 64 of them at most, each wrong by one cell at most.
TEST(PhaseLight, BlursAnEdgeByTheSegmentOfTheLensThatSeesPastIt) {
  PhaseCamera camera = one_pixel();
  camera.sub_rays = 64;
  camera.aperture_m = 0.01;
  camera.focus_m = 2;
  const double z_n = 1.2;
  for (const double t : {-0.8, -0.3, 0.0, 0.5}) {
    const double x_focus_m = -t * 0.005 * (2 - z_n) / z_n;
    camera.camera.cx_px = -x_focus_m / 2 * 1e6;
    const Scene near_only{.objects = {plate(z_n, -1, 1)}, .materials = {plain(0.6)}};
    const Scene far_only{.objects = {plane_at(2)}, .materials = {plain(0.6)}};
    const Scene both{.objects = {plate(z_n, -1, 0), plane_at(2)}, .materials = {plain(0.6)}};
    const double segment = (pi / 2 + std::asin(t) + t * std::sqrt(1 - t * t)) / pi;
    const Phasor near_light = light_at(camera, near_only, 0, 0).amplitude_e[0];
    const Phasor far_light = light_at(camera, far_only, 0, 0).amplitude_e[0];
    const Phasor light = light_at(camera, both, 0, 0).amplitude_e[0];
    EXPECT_LT(std::abs(light - segment * near_light - (1 - segment) * far_light),
              2.0 / 64 * std::abs(near_light - far_light))
        << t;
  }
}

// pi f cos of the light over the distance squared, for a surface that is no Lambert one and light
// beside the lens; ambient light by the albedo towards the lens.
TEST(PhaseLight, ReflectsAsTheSurfacesBsdfSays) {
  PhaseCamera camera = one_pixel();
  camera.emitter_offset_m = 0.2;
  camera.ambient_electrons = 100;
  const Bsdf metal = Conductor{.eta = 2, .k = 3, .roughness = 0.5};
  const double tilt = 0.3;
  const Scene scene{.objects = {plane_at(1, tilt)},
                    .materials = {{.name = "metal", .bsdf = metal, .texture = {}}}};
  const PixelPhasors light = light_at(camera, scene, 0, 0);
  // In the plane of incidence: the normal (-sin, 0, -cos), the lens at (0, 0, -1) and the light at
  // (0.2, 0, -1) from the point.
  const double to_light = std::atan2(0.2, 1);
  const auto at_angle = [](double angle) {
    return Eigen::Vector3d(std::sin(angle), 0, std::cos(angle));
  };
  const Eigen::Vector3d out = at_angle(tilt), in = at_angle(tilt + to_light);
  const double electrons = 20000 * pi * evaluate(metal, out, in) * in.z() / (1 + 0.2 * 0.2);
  EXPECT_GT(electrons, 0);
  EXPECT_NEAR(std::abs(light.amplitude_e[0]), 0.5 * electrons, 1e-9 * electrons);
  EXPECT_NEAR(light.constant_e, electrons + 100 * albedo(metal, out), 1e-9 * electrons);
}

// The same view two ways: by the camera model, ray by ray, and by the kernel.
TEST(PhaseLight, SeesThroughAPinholeAsThroughAnyLens) {
  PhaseCamera camera = one_pixel();
  camera.camera = {640, 480, 500, 510, 320.3, 239.1};
  camera.vignetting = 0.7;
  ASSERT_TRUE(is_pinhole(camera));
  const Pose world_from_scanner = make_pose(
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {4, 5, 6});
  ViewBatch one_by_one, together;
  for (std::size_t i = 0; i < ViewBatch::most; ++i) {
    const Eigen::Vector2d place(9.7 * static_cast<double>(i), 480 - 7.1 * static_cast<double>(i));
    one_by_one.add(world_from_scanner, *lens_ray(camera, place, {0, 0}), i);
    together.add(place, i);
  }
  together.aim(camera, world_from_scanner);
  for (std::size_t i = 0; i < ViewBatch::most; ++i) {
    const LensRay &a = one_by_one.view(i), &b = together.view(i);
    EXPECT_LT((a.ray.direction - b.ray.direction).norm(), 1e-15);
    EXPECT_LT((one_by_one.direction_in_world(i) - together.direction_in_world(i)).norm(), 1e-15);
    EXPECT_EQ(b.ray.origin, Eigen::Vector3d::Zero());
    EXPECT_NEAR(a.share, b.share, 1e-15);
    EXPECT_EQ(together.owner(i), i);
  }
  camera.camera.k1 = 0.01;
  EXPECT_FALSE(is_pinhole(camera));
  camera.camera.k1 = 0;
  camera.aperture_m = 0.01;
  EXPECT_FALSE(is_pinhole(camera));
}

TEST(PinholeRays, AreTheSameBytesByEveryKernel) {
  const Pinhole pinhole{500, 510, 320, 240, 0.3, {{0.8, 0.6, 0}, {-0.6, 0.8, 0}, {0, 0, 1}}};
  PinholeRays plain;
  for (std::size_t i = 0; i < PinholeRays::most; ++i) {
    plain.column_px[i] = 9.3 * static_cast<double>(i);
    plain.row_px[i] = 100 + 3.1 * static_cast<double>(i);
  }
  PinholeRays other = plain;
  pinhole_kernels().front()(pinhole, PinholeRays::most, plain);
  for (PinholeKernel* const kernel : pinhole_kernels()) {
    kernel(pinhole, PinholeRays::most, other);
    EXPECT_EQ(std::memcmp(&plain, &other, sizeof plain), 0);
  }
}

// Every pixel once, from wherever the walk begins, and sixteen in a row are a square.
TEST(TileWalk, MeetsEachPixelOnce) {
  for (const auto& [width, height] : {std::pair(16, 8), {7, 9}, {3, 2}, {1, 5}, {21, 4}}) {
    const auto pixels = static_cast<std::size_t>(width * height);
    std::vector<int> visits(pixels, 0);
    TileWalk walk(0, width, height);
    for (std::size_t i = 0; i < pixels; ++i, walk.next()) {
      const PixelPlace place = walk.place();
      ASSERT_LT(place.column, width);
      ASSERT_LT(place.row, height);
      ++visits[index_of(place, width)];
      const PixelPlace anew = TileWalk(i, width, height).place();
      ASSERT_EQ(index_of(anew, width), index_of(place, width)) << i;
      if (width == 16) {
        ASSERT_EQ(place.column / 4, static_cast<int>(i / 16 % 4));
        ASSERT_EQ(place.row / 4, static_cast<int>(i / 64));
      }
    }
    for (const int count : visits) EXPECT_EQ(count, 1);
  }
}

}  // namespace
}  // namespace scan::synth
