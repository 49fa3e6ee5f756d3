// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The planner's bounds against what leaving an effect out does, on scenes built to meet them: the
// error is within the bound and not below a tenth of it.
#include <gtest/gtest.h>

#include <cmath>

#include "synth/effects/weight.h"
#include "tests/validation/laser_scans.h"

namespace scan::synth {
namespace {

LaserLine device() {
  LaserLine s = small_laser();
  s.steps = 30;
  s.step_m = 1e-3;
  s.stage_direction = {0, 1, 0};
  s.beam_radius_m = 2e-3;
  s.sensor = {.gain_e_per_dn = 0.2, .full_well_e = 1e9, .bits = 16};
  return s;
}

double bound_m(const LaserLine& s, const Scene& scene, Effect effect) {
  const auto rays = pilot(s, RayCaster(scene), Pose::Identity(), 2000);
  const Weighed weighed = weigh(s, scene, effect, rays);
  EXPECT_TRUE(weighed.weight.has_value()) << weighed.why_absent;
  return weighed.weight ? weighed.weight->bound_m : 0;
}

// With the effect against without it, all else ideal.
Differences change(const LaserLine& s, const Scene& scene, Effect effect) {
  return differences(decoded(s, scene, EffectSet(noise_free).set(effect)).range_m,
                     decoded(s, scene, noise_free).range_m);
}

// The same by the centroid of whole rows: a window may choose between the parts of a stripe that an
// edge cuts in two.
Differences change_of_centroid(const LaserLine& s, const Scene& scene, Effect effect) {
  return differences(centroid_ranges(s, scene, EffectSet(noise_free).set(effect)),
                     centroid_ranges(s, scene, noise_free));
}

void expect_bound(double error_m, double bound, const char* what) {
  std::printf("bound: %-16s error %.3g mm, bound %.3g mm\n", what, error_m * 1e3, bound * 1e3);
  EXPECT_LE(error_m, bound) << what;
  EXPECT_GE(error_m, bound / 10) << what;
}

// Noises are bounded by three sigma of the weakest row; so is their root mean square over 3600
// rows, uncertain by 1.2 %.
TEST(LaserBound, HoldsForNoises) {
  LaserLine s = device();
  const Scene scene = white_scene({plane_at(focus_z(s))});
  for (const Effect effect : {Effect::shot_noise, Effect::read_noise, Effect::speckle}) {
    LaserLine noisy = s;
    noisy.sensor.offset_dn = 2000;
    noisy.sensor.read_noise_e = 30;
    noisy.wavelength_m = 650e-9;
    noisy.aperture_m = 2e-3;
    noisy.speckle_contrast = 0.5;
    const Differences d = change(noisy, scene, effect);
    ASSERT_GT(d.count, 3000);
    expect_bound(3 * d.rms, bound_m(noisy, scene, effect), std::string(name(effect)).c_str());
  }
}

TEST(LaserBound, HoldsForAmbientLight) {
  LaserLine s = device();
  s.ambient_electrons = 400;
  const Scene scene = white_scene({plane_at(focus_z(s))});
  const EffectSet shot = EffectSet(noise_free).set(Effect::shot_noise);
  const auto clean = decoded(s, scene, noise_free).range_m;
  const double with =
      differences(decoded(s, scene, EffectSet(shot).set(Effect::scene_lights)).range_m, clean).rms;
  const double without = differences(decoded(s, scene, shot).range_m, clean).rms;
  expect_bound(3 * std::sqrt(with * with - without * without),
               bound_m(s, scene, Effect::scene_lights), "scene lights");
}

// Coarse steps of the converter, before a sloping plane so that the stripe takes all places.
TEST(LaserBound, HoldsForRounding) {
  LaserLine s = device();
  s.sensor = {.gain_e_per_dn = 100, .bits = 8};
  const Scene scene = white_scene({plane_at(focus_z(s), 0.2)});
  LaserLine fine = s;
  fine.sensor = {.gain_e_per_dn = 0.2, .bits = 16};
  const Differences d =
      differences(decoded(s, scene, noise_free).range_m, decoded(fine, scene, noise_free).range_m);
  expect_bound(d.largest, bound_m(s, scene, Effect::quantisation), "quantisation");
}

TEST(LaserBound, HoldsForBowAndMiscalibration) {
  LaserLine s = device();
  s.plane_bow_m = 1e-4;
  s.plane_shift_m = 5e-5;
  s.plane_turn_rad = 3e-4;
  for (const double tilt_rad : {0.0, 0.4, -0.4}) {
    const Scene scene = white_scene({plane_at(focus_z(s), tilt_rad)});
    for (const Effect effect : {Effect::plane_bow, Effect::miscalibration})
      expect_bound(change(s, scene, effect).largest, bound_m(s, scene, effect),
                   std::string(name(effect)).c_str());
  }
}

// At a step of reflectance of 50, swept through the beam, by the centroid: what another width does.
TEST(LaserBound, HoldsForWidthsAtAnEdge) {
  LaserLine s = device();
  s.stage_direction = {1, 0, 0};
  s.step_m = 2e-4;
  s.steps = 41;
  s.sub_rays = 4;
  s.camera.height_px = 5;
  s.camera.cy_px = 2;
  s.wavelength_m = 650e-9;
  s.beam_quality = 300;
  s.aperture_m = 4e-3;
  s.lens_focus_m = 0.3;
  const double z = 0.15;
  const Eigen::Vector3d edge(s.baseline_m - z * std::tan(theta), 0, z);
  const Scene scene = reflectance_step(edge, {0, 0, 1}, 50);
  for (const Effect effect : {Effect::beam_spread, Effect::defocus})
    expect_bound(change_of_centroid(s, scene, effect).largest, bound_m(s, scene, effect),
                 std::string(name(effect)).c_str());
}

// The head runs along x past the same edge, its shutter open all the time.
TEST(LaserBound, HoldsForMotion) {
  LaserLine s = device();
  s.stage_direction = {1, 0, 0};
  s.steps = 21;
  s.step_m = 2e-3;
  s.sub_rays = 4;
  s.exposure_share = 1;
  s.camera.height_px = 5;
  s.camera.cy_px = 2;
  const Scene scene = reflectance_step({0, 0, focus_z(s)}, {0, 0, 1}, 50);
  expect_bound(change_of_centroid(s, scene, Effect::motion).largest,
               bound_m(s, scene, Effect::motion), "motion");
}

TEST(LaserBound, HoldsForAWallThatShines) {
  LaserLine s = device();
  s.steps = 1;
  s.camera.height_px = 40;
  s.camera.cy_px = 19.5;
  s.beam_radius_m = 1e-3;
  s.sensor.read_noise_e = 10;  // not drawn: how well paths need to be known
  const double z = 0.2;
  const Scene scene = white_scene({plane_at(z, 0.75), plane_at(z, -0.75)});
  expect_bound(change(s, scene, Effect::interreflection).largest,
               bound_m(s, scene, Effect::interreflection), "interreflection");
}

}  // namespace
}  // namespace scan::synth
