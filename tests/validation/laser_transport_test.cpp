// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A laser line before what is not opaque, under other lights, in fog.
#include <gtest/gtest.h>

#include <cmath>

#include "synth/scanners/laser_line_paths.h"
#include "tests/validation/laser_scans.h"

namespace scan::synth {
namespace {

// A head with a camera of few rows; its paths need not be better than a read noise that is not
// drawn.
LaserLine device() {
  LaserLine s = small_laser();
  s.camera.height_px = 8;
  s.camera.cy_px = 3.5;
  s.beam_radius_m = 1e-3;
  s.sensor = {.gain_e_per_dn = 1, .read_noise_e = 10, .bits = 16};
  return s;
}

// A body without a boundary (index 1) that scatters evenly in all directions, mean free path l.
Scene body(double depth_m, double mean_free_path_m) {
  Scene scene = white_scene({plane_at(depth_m)});
  scene.materials[0] = {.name = "marble",
                        .bsdf = Dielectric{.index = 1},
                        .interior = Medium{.absorption_per_m = 0.1 / mean_free_path_m,
                                           .scattering_per_m = 0.9 / mean_free_path_m}};
  return scene;
}

// Light flies on by l on the mean before it is scattered and has forgotten where it came from: the
// stripe's centre lies l sin(theta) farther along, and the decoder puts it l cos(theta) too deep.
// The camera sees light that left upright, which had been less deep than the mean; measured on
// marble: always into the body, by some tens of micrometres (Levoy 2002). Between a fifth of l
// cos(theta) and all of it, and in proportion to l.
TEST(LaserOnTranslucentBody, IsDecodedBelowTheSurface) {
  LaserLine s = device();
  s.peak_electrons = 20000;
  s.camera.height_px = 4;
  s.camera.cy_px = 1.5;
  const double z = focus_z(s);
  const EffectSet effects = EffectSet(noise_free).set(Effect::subsurface);
  double shift_m[2];
  for (const int i : {0, 1}) {
    const double l = (i + 1) * 5e-4;
    double sum = 0;
    const auto ranges = centroid_ranges(s, body(z, l), effects);
    const auto white = centroid_ranges(s, white_scene({plane_at(z)}), noise_free);
    for (std::size_t k = 0; k < ranges.size(); ++k)
      sum += (ranges[k] - white[k]) / static_cast<double>(ranges.size());
    shift_m[i] = sum;
    std::printf("translucent: l %.1f mm, shift %.3f mm\n", l * 1e3, shift_m[i] * 1e3);
    EXPECT_GT(shift_m[i], 0.2 * l * std::cos(theta));
    EXPECT_LT(shift_m[i], l * std::cos(theta));
  }
  EXPECT_NEAR(shift_m[1] / shift_m[0], 2, 0.6);
}

// A lamp of 1 W/sr at 1 m before a wall of albedo 0.4: 1 W/m^2 at its foot, cos^3 / h^2 elsewhere.
TEST(LaserUnderALamp, CollectsItsIrradiance) {
  LaserLine s = device();
  s.electrons_per_w_m2 = 5000;
  const double z = 0.25;
  Scene scene = white_scene({plane_at(z)});
  scene.materials[0].bsdf = Lambert{0.4};
  scene.lights.push_back(PointLight{.position_m = {0, 0, z - 1}, .intensity_w_sr = 1});
  const RayCaster caster(scene);
  const auto lit = first_image(s, caster, EffectSet(noise_free).set(Effect::scene_lights));
  const auto dark = first_image(s, caster, noise_free);
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 160; ++column) {
      const Eigen::Vector3d x = z * *ray_through(s.camera, {double(column), double(row)});
      const double cosine = 1 / std::sqrt(1 + x.head<2>().squaredNorm());
      EXPECT_NEAR(lit(column, row) - dark(column, row), 0.4 * 5000 * std::pow(cosine, 3), 1.001);
    }
}

// Fog takes light on both ways: exp(-sigma (r + R)); what it scatters into the view adds less than
// its share of the beam's width, 1e-3.
TEST(LaserInFog, FadesAsBeerAndLambertSay) {
  LaserLine s = device();
  s.peak_electrons = 50000;
  const double z = focus_z(s), extinction_per_m = 2;
  Scene scene = white_scene({plane_at(z)});
  const auto clear = first_image(s, RayCaster(scene), noise_free);
  scene.medium = Medium{.absorption_per_m = 1, .scattering_per_m = 1};
  const auto foggy = first_image(s, RayCaster(scene), EffectSet(noise_free).set(Effect::medium));
  double found = 0, expected = 0;
  for (int column = 60; column < 100; ++column) {
    found += foggy(column, 3);
    expected += clear(column, 3);
  }
  const double ways_m = z + z / std::cos(theta);
  EXPECT_NEAR(found / expected, std::exp(-extinction_per_m * ways_m), 0.01);
}

// However much noise there is, the stripe's own pixels are rendered: with so few paths their sum is
// known to some per cent.
TEST(LaserInFog, KeepsAStripeThatNoiseHides) {
  LaserLine s = device();
  Scene scene = white_scene({plane_at(focus_z(s))});
  scene.medium = Medium{.absorption_per_m = 0.1, .scattering_per_m = 0.1};
  const EffectSet effects = EffectSet(noise_free).set(Effect::medium);
  const auto clear = first_image(s, RayCaster(scene), effects);
  s.sensor.read_noise_e = 1e6;  // not drawn
  const auto noisy = first_image(s, RayCaster(scene), effects);
  for (int row = 0; row < 8; ++row) {
    double found = 0, expected = 0;
    for (int column = 60; column < 100; ++column) {
      found += noisy(column, row);
      expected += clear(column, row);
    }
    EXPECT_NEAR(found / expected, 1, 0.2);
  }
}

}  // namespace
}  // namespace scan::synth
