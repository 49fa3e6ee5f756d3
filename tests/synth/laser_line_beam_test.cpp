// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/synth/laser_bench.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// The stripe of one row at a hundredth of a pixel.
struct Stripe {
  double sum = 0;
  double mean_px = 0;
  double sigma_px = 0;
};

Stripe stripe(const Bench& bench, double row) {
  Stripe s;
  double squares = 0;
  for (double u = 0; u < 160; u += 0.01) {
    const double e = bench.electrons(u, row);
    s.sum += e * 0.01;
    s.mean_px += e * u * 0.01;
    squares += e * u * u * 0.01;
  }
  s.mean_px /= s.sum;
  s.sigma_px = std::sqrt(squares / s.sum - s.mean_px * s.mean_px);
  return s;
}

LaserLine spreading_laser() {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-4;
  s.wavelength_m = 650e-9;
  s.beam_quality = 4;
  return s;
}

// w(z) = w0 sqrt(1 + (z / zR)^2), zR = pi w0^2 / (M^2 lambda): 1e-4 m, M^2 = 4: 12.08 mm.
TEST(BeamSpread, IsThatOfAGaussianBeam) {
  const LaserSheet sheet = laser_sheet(spreading_laser());
  const double rayleigh_m = pi * 1e-8 / (4 * 650e-9);
  EXPECT_NEAR(rayleigh_m, 12.083e-3, 1e-6);
  EXPECT_NEAR(sheet.focus_m, 0.1 / std::sin(theta), 1e-15);
  EXPECT_EQ(sheet.radius_m(sheet.focus_m), 1e-4);
  EXPECT_NEAR(sheet.radius_m(sheet.focus_m + rayleigh_m), std::sqrt(2) * 1e-4, 1e-18);
  EXPECT_NEAR(sheet.radius_m(sheet.focus_m - 3 * rayleigh_m), std::sqrt(10) * 1e-4, 1e-18);
  EXPECT_EQ(laser_sheet(small_laser()).radius_m(7), small_laser().beam_radius_m);
}

// On planes across the view, in the row of the axis: sigma = w / 2 / cos(theta) f / z. The slope of
// brightness across the stripe, at most 3 / z, shifts the centre by sigma^2 of it and changes its
// square by as much squared: 1e-4 for sigma = 1 mm at 0.25 m, z tan(theta) f b of perspective.
TEST(BeamSpread, WidensTheStripeAndKeepsItsEnergy) {
  const LaserLine s = spreading_laser();
  LaserLine ideal = s;
  ideal.beam_quality = 0;
  for (const double z : {focus_z(s), 0.15, 0.25}) {
    const Scene scene = white_scene({plane_at(z)});
    const Stripe real = stripe(Bench(s, scene), 59.5), thin = stripe(Bench(ideal, scene), 59.5);
    const double radius_m = laser_sheet(s).radius_m(z / std::cos(theta));
    const double sigma_px = radius_m / 2 / std::cos(theta) * 300 / z;
    EXPECT_NEAR(real.sigma_px, sigma_px, 1e-3 * sigma_px) << z;
    EXPECT_NEAR(real.sum, thin.sum, 1e-3 * thin.sum) << z;
  }
}

// Where the stripe is seen, the point on the plane has the distance bow (phi / half fan)^2 r / r_f
// from the light plane. A beam of 10 um is straight enough: its skew moves it by 1e-6 px.
TEST(PlaneBow, MovesTheStripeBySagOverTheFan) {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-5;
  s.plane_bow_m = 4e-4;
  const LaserSheet sheet = laser_sheet(s);
  for (const double z : {0.15, 0.2})
    for (const int row : {0, 30, 59, 100}) {
      const Bench bench(s, white_scene({plane_at(z)}));
      const double column = stripe(bench, row).mean_px;
      const Eigen::Vector3d x = z * *ray_through(s.camera, {column, double(row)});
      const Eigen::Vector3d path = x - sheet.origin;
      const double phi = std::atan2(path.y(), path.dot(sheet.middle));
      const double sag = 4e-4 * std::pow(phi / 0.4, 2) * path.norm() / (0.1 / std::sin(theta));
      // 0.01 px of sampling at a stripe of sigma 0.01 px: 1e-3 px, 0.6 um
      EXPECT_NEAR(sheet.normal.dot(x) - sheet.offset_m, sag, 1e-6) << z << " " << row;
    }
}

// Sheet and rays agree: what shine() hits is in the middle of the light.
TEST(PlaneBow, IsTheSameForwardsAndBackwards) {
  LaserLine s = small_laser();
  s.plane_bow_m = 1e-3;
  const Bench bench(s, white_scene({plane_at(0.2)}));
  for (const double angle : {-0.35, 0.0, 0.2}) {
    const SheetHit point = bench.view.shine(angle, 0);
    ASSERT_TRUE(point.is_hit);
    const double here = bench.electrons(point.pixel.x(), point.pixel.y());
    EXPECT_GT(here, 1000);
    // the brightness' own slope over the stripe: 1e-6 of it per 0.01 px
    EXPECT_LT(bench.electrons(point.pixel.x() + 0.01, point.pixel.y()), here * (1 + 1e-6));
    EXPECT_LT(bench.electrons(point.pixel.x() - 0.01, point.pixel.y()), here * (1 + 1e-3));
  }
}

TEST(Miscalibration, MovesTheRealPlaneAndNotTheCalibratedOne) {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-5;
  s.plane_shift_m = 3e-4;
  s.plane_turn_rad = 2e-3;
  const double z = 0.2;
  const RayCaster caster(white_scene({plane_at(z)}));
  const Rendering rendering =
      render(s, caster, Pose::Identity(), {}, EffectSet(noise_free).set(Effect::miscalibration));
  const LaserSheet told = laser_sheet(small_laser());
  const auto& calibration = std::get<StripeImages>(rendering.frames).calibration;
  EXPECT_EQ(calibration.plane_normal, told.normal);
  EXPECT_EQ(calibration.plane_offset_m, told.offset_m);
  const double column = stripe(Bench(s, white_scene({plane_at(z)})), 59.5).mean_px;
  const double x = (column - 79.5) / 300 * z;
  const double turned = theta + 2e-3;
  const Eigen::Vector2d laser(0.1 + 3e-4 * std::cos(turned), 3e-4 * std::sin(turned));
  // 1e-6 m: as above
  EXPECT_NEAR(x, laser.x() - (z - laser.y()) * std::tan(turned), 1e-6);
}

TEST(LaserStripe, FollowsTheBsdf) {
  const LaserLine s = small_laser();
  const double z = focus_z(s);
  Scene scene = white_scene({plane_at(z)});
  const Conductor metal{.roughness = 0.4};
  scene.materials[0].bsdf = metal;
  // the camera looks along the normal, the light comes at theta
  const Eigen::Vector3d out(0, 0, 1), in(std::sin(theta), 0, std::cos(theta));
  EXPECT_NEAR(Bench(s, scene).electrons(79.5, 59.5),
              s.peak_electrons * pi * evaluate(Bsdf(metal), out, in), 1e-9 * s.peak_electrons);
}

TEST(AmbientLight, FallsOnTheWholeImage) {
  LaserLine s = small_laser();
  s.ambient_electrons = 1000;
  Scene scene = white_scene({plane_at(0.2)});
  scene.materials[0].bsdf = Lambert{0.3};
  const RayCaster caster(scene);
  const auto image = [&](const EffectSet& effects) { return first_image(s, caster, effects); };
  const auto lit = image(EffectSet(noise_free).set(Effect::scene_lights)), dark = image(noise_free);
  for (std::size_t i = 0; i < lit.pixels.size(); ++i)
    EXPECT_NEAR(lit.pixels[i] - dark.pixels[i], 300, 1);
}

// A device with every imperfection, each effect alone: it changes the image, and the others leave
// no trace of theirs.
TEST(LaserEffects, AreEachOnTheirOwn) {
  LaserLine s = spreading_laser();
  s.sensor = {.gain_e_per_dn = 1, .full_well_e = 2000, .bits = 16};
  s.beam_radius_m = 5e-4;
  s.beam_quality = 100;
  s.plane_bow_m = 1e-3;
  s.plane_shift_m = 1e-4;
  s.aperture_m = 5e-3;
  s.lens_focus_m = 0.3;
  s.speckle_contrast = 1;
  s.exposure_share = 1;
  s.stage_direction = {0, 0, 1};
  s.step_m = 5e-3;
  s.blooming_share = 1;
  s.ambient_electrons = 100;
  LaserLine ideal = small_laser();
  ideal.sensor = s.sensor;
  ideal.beam_radius_m = s.beam_radius_m;
  const RayCaster caster(white_scene({sphere_at({0, 0, 0.18}, 0.03), plane_at(0.25)}));
  const auto image = [&](const LaserLine& device, const EffectSet& effects) {
    return first_image(device, caster, effects).pixels;
  };
  const auto plain_image = image(ideal, noise_free);
  EXPECT_EQ(image(s, noise_free), plain_image);
  const EffectSet of_the_device = EffectSet::all()
                                      .without(Effect::shot_noise)
                                      .without(Effect::read_noise)
                                      .without(Effect::interreflection);
  EXPECT_EQ(image(ideal, of_the_device), plain_image);
  for (const Effect effect :
       {Effect::beam_spread, Effect::plane_bow, Effect::miscalibration, Effect::defocus,
        Effect::speckle, Effect::motion, Effect::blooming, Effect::scene_lights})
    EXPECT_NE(image(s, EffectSet(noise_free).set(effect)), plain_image) << name(effect);
}

TEST(LaserEffects, AreTheSameOnAnyNumberOfThreads) {
  LaserLine s = spreading_laser();
  s.steps = 2;
  s.speckle_contrast = 0.7;
  s.aperture_m = 1e-3;
  s.exposure_share = 0.5;
  s.blooming_share = 0.5;
  s.sensor = {.gain_e_per_dn = 2, .read_noise_e = 5, .full_well_e = 4000, .bits = 12};
  const RayCaster caster(white_scene({sphere_at({0, 0, 0.18}, 0.03)}));
  expect_same_for_any_thread_count([&] {
    std::vector<std::uint16_t> all;
    const Rendering rendering = render(s, caster, Pose::Identity(), {3, 1}, EffectSet::all());
    for (const auto& image : std::get<StripeImages>(rendering.frames).images)
      all.insert(all.end(), image.pixels.begin(), image.pixels.end());
    return all;
  });
}

TEST(LaserLineCheck, KnowsWhatARealDeviceNeeds) {
  LaserLine s = small_laser();
  s.speckle_contrast = 0.5;
  s.wavelength_m = 0;
  EXPECT_NE(complaint(s).find("laser_line/wavelength_m"), std::string::npos);
  s.wavelength_m = 650e-9;
  EXPECT_NE(complaint(s).find("laser_line/aperture_m"), std::string::npos);
  s.aperture_m = 1e-3;
  EXPECT_EQ(complaint(s), "");
  s.beam_quality = 0.5;
  EXPECT_NE(complaint(s).find("laser_line/beam_quality"), std::string::npos);
  s.beam_quality = 1;
  s.exposure_share = 1.5;
  EXPECT_NE(complaint(s).find("laser_line/exposure_share"), std::string::npos);
  s.exposure_share = 1;
  s.blooming_share = -1;
  EXPECT_NE(complaint(s).find("laser_line/blooming_share"), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
