// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tests/synth/laser_bench.h"

namespace scan::synth {
namespace {

TEST(LaserSheet, HoldsTheLaserTheFocusAndTheCamerasYAxis) {
  const LaserLine s = small_laser();
  const LaserSheet sheet = laser_sheet(s);
  const auto distance = [&](const Eigen::Vector3d& x) {
    return sheet.normal.dot(x) - sheet.offset_m;
  };
  EXPECT_NEAR(distance({s.baseline_m, 0, 0}), 0, 1e-16);
  EXPECT_NEAR(distance({0, 0, focus_z(s)}), 0, 1e-16);
  EXPECT_NEAR(sheet.normal.y(), 0, 0);
  EXPECT_NEAR(fan_direction(sheet, 0.3).norm(), 1, 1e-15);
  EXPECT_NEAR(fan_direction(sheet, 0.3).dot(sheet.normal), 0, 1e-16);
}

// On a plane at z the sheet's middle stands at x = b - z tan(theta). A beam of 10 um moves the
// brightness' centre by its slope sin(theta)/r times sigma^2, below 1e-6 px.
TEST(LaserStripe, LiesWhereTheLightPlaneMeetsThePlane) {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-5;
  for (const double z : {0.15, 0.183, 0.25}) {
    const Bench bench(s, white_scene({plane_at(z)}));
    const double expected_px = 79.5 + 300 * (s.baseline_m - z * std::tan(theta)) / z;
    for (const int row : {10, 60, 100}) {
      double weight = 0, moment = 0;
      for (double u = -0.2; u <= 0.2; u += 1e-4) {
        const double e = bench.electrons(expected_px + 1e-5 + u, row);
        weight += e;
        moment += e * (u + 1e-5);
      }
      EXPECT_GT(weight, 0);
      EXPECT_NEAR(moment / weight, 0, 1e-6) << z << " " << row;
    }
  }
}

TEST(LaserStripe, HasItsPeakElectronsOnAWhiteTargetAtTheFocus) {
  const LaserLine s = small_laser();
  const double z = focus_z(s);
  EXPECT_NEAR(Bench(s, white_scene({plane_at(z)})).electrons(79.5, 59.5), s.peak_electrons,
              1e-9 * s.peak_electrons);
  // twice as far: the same angles, the light spread over twice the height
  const double column = 79.5 + 300 * (s.baseline_m - 2 * z * std::tan(theta)) / (2 * z);
  EXPECT_NEAR(Bench(s, white_scene({plane_at(2 * z)})).electrons(column, 59.5),
              s.peak_electrons / 2, 1e-9 * s.peak_electrons);
  // turned to face the laser (-theta), or away from it by as much
  for (const double tilt : {theta, -theta}) {
    const double gain = std::cos(theta + tilt) / std::cos(theta);
    EXPECT_NEAR(Bench(s, white_scene({plane_at(z, tilt)})).electrons(79.5, 59.5),
                s.peak_electrons * gain, 1e-9 * s.peak_electrons)
        << tilt;
  }
  Scene grey = white_scene({plane_at(z)});
  grey.materials[0].bsdf = Lambert{0.25};
  EXPECT_NEAR(Bench(s, grey).electrons(79.5, 59.5), s.peak_electrons / 4, 1e-9 * s.peak_electrons);
}

// Integral of the Gaussian across the plane: peak w sqrt(pi / 2), wider by 1 / cos(theta) on the
// target.
TEST(LaserStripe, HoldsTheEnergyOfItsGaussian) {
  const LaserLine s = small_laser();
  const Bench bench(s, white_scene({plane_at(focus_z(s))}));
  double sum = 0;
  const double step = 1e-3;
  for (double u = -3; u <= 3; u += step) sum += bench.electrons(79.5 + u, 59.5) * step;
  const double px_per_m = 300 / focus_z(s);
  const double expected = s.peak_electrons * s.beam_radius_m * std::sqrt(std::numbers::pi / 2) /
                          std::cos(theta) * px_per_m;
  // the slope of brightness across the stripe is odd; its square is 1e-7 here
  EXPECT_NEAR(sum / expected, 1, 1e-6);
}

TEST(LaserStripe, EndsWithTheFan) {
  LaserLine s = small_laser();
  s.fan_rad = 0.2;
  const Bench bench(s, white_scene({plane_at(focus_z(s))}));
  const double end_px = std::tan(0.1) * s.baseline_m / std::sin(theta) / focus_z(s) * 300;
  EXPECT_GT(bench.electrons(79.5, 59.5 + end_px - 0.01), 0);
  EXPECT_EQ(bench.electrons(79.5, 59.5 + end_px + 0.01), 0);
}

TEST(LaserStripe, IsDarkInShadowAndBehindObstacles) {
  const LaserLine s = small_laser();
  const double z = focus_z(s), x_light = s.baseline_m / 2;
  // a plate across the laser's way, half way, out of the camera's view of the stripe
  const Scene shadow = white_scene({plane_at(z), plate(z / 2, x_light - 0.01, x_light + 0.01)});
  EXPECT_EQ(Bench(s, shadow).electrons(79.5, 59.5), 0);
  // a plate across the camera's way
  const Scene hidden = white_scene({plane_at(z), plate(z / 2, -0.01, 0.01)});
  EXPECT_EQ(Bench(s, hidden).electrons(79.5, 59.5), 0);
  const auto truth = true_rays(s, RayCaster(hidden), Pose::Identity());
  const auto lit = true_rays(s, RayCaster(white_scene({plane_at(z)})), Pose::Identity());
  EXPECT_EQ(lit[60].object, 0);
  EXPECT_EQ(truth[60].object, -1);
  const auto in_shadow = true_rays(s, RayCaster(shadow), Pose::Identity());
  EXPECT_EQ(in_shadow[60].object, -1) << "the lit place on the plate is out of the image";
}

// The image's brightest pixel and centre, through mask, sub-rays and detector.
TEST(LaserImages, ShowTheStripeWhereItIs) {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-3;
  s.sub_rays = 2;
  s.peak_electrons = 60000;
  const double z = 0.2;
  const RayCaster caster(white_scene({plane_at(z)}));
  const RawFrames frames = render(s, caster, Pose::Identity(), {}, noise_free).frames;
  const auto& stripe = std::get<StripeImages>(frames);
  ASSERT_EQ(stripe.images.size(), 1u);
  const double expected_px = 79.5 + 300 * (s.baseline_m - z * std::tan(theta)) / z;
  for (int row = 0; row < 120; ++row) {
    double weight = 0, moment = 0;
    for (int column = 0; column < 160; ++column) {
      const double e = stripe.images[0](column, row);
      weight += e;
      moment += e * (column - expected_px);
    }
    // slopes of brightness, at most 3 / r with r > 0.2 m, shift the centre by slope sigma^2
    const double sigma_m = s.beam_radius_m / 2 / std::cos(theta);
    EXPECT_NEAR(moment / weight, 0, 3 / 0.2 * sigma_m * sigma_m * 300 / z + 1e-3) << row;
  }
}

// No light falls outside the mask: against the whole image, on forms with limbs, edges and shadows.
TEST(LaserImages, MissNoLightOutsideTheTracedBand) {
  LaserLine s = small_laser();
  s.beam_radius_m = 4e-4;  // half a pixel
  const auto placed = [](double rx, double ry, double z) {
    const Eigen::Vector3d turn(rx, ry, 0.3);
    return make_pose(Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix(),
                     {0, 0, z});
  };
  for (const Object& object : {sphere_at({0.005, 0.01, 0.17}, 0.03), plate(0.15, -0.002, 0.02),
                               Object{"bud", placed(0.5, 0.4, 0.2), bud(), 0},
                               Object{"bracket", placed(2, 0.4, 0.2), bracket(), 0}}) {
    const Bench bench(s, white_scene({object, plane_at(0.25)}));
    const Image<std::uint8_t> band = lit_band(bench.view);
    int lit = 0, outside = 0, traced = 0;
    for (int row = 0; row < 120; ++row)
      for (int column = 0; column < 160; ++column) {
        const bool is_lit = bench.electrons(column, row) > 0.01;
        lit += is_lit;
        traced += band(column, row);
        outside += is_lit && !band(column, row);
      }
    EXPECT_GT(lit, 60) << object.name;
    EXPECT_EQ(outside, 0) << object.name;
    EXPECT_LT(traced, 160 * 120 / 4) << object.name;
  }
}

// The sheet's edge grazes the side of a ball that the camera sees: between two rays of the sheet,
// one on the ball and one past it, the light runs on for many pixels.
TEST(LaserImages, MissNoLightUpToALimb) {
  LaserLine s = small_laser();
  s.camera.fx_px = s.camera.fy_px = 1500;
  s.beam_radius_m = 4e-4;
  const Eigen::Vector3d focus(0, 0, focus_z(s));
  int lit = 0, outside = 0;
  for (double depth_m = 2e-5; depth_m < 5e-4; depth_m += 4e-5) {
    const double radius = 0.05;
    const Eigen::Vector3d centre = focus + (radius - depth_m) * laser_sheet(s).normal;
    const Bench bench(s, white_scene({sphere_at(centre, radius)}));
    const Image<std::uint8_t> band = lit_band(bench.view);
    for (int row = 0; row < 120; row += 7)
      for (int column = 0; column < 160; ++column) {
        const bool is_lit = bench.electrons(column, row) > 0.01;
        lit += is_lit;
        outside += is_lit && !band(column, row);
      }
  }
  EXPECT_GT(lit, 2000);
  EXPECT_EQ(outside, 0);
}

TEST(LaserSweep, MovesAlongItsStageOrAboutItsAxis) {
  LaserLine s = small_laser();
  s.steps = 5;
  s.step_m = 0.01;
  s.stage_direction = {0, 3, 4};
  auto poses = scanner_from_camera(s);
  EXPECT_NEAR((poses[2].matrix() - Eigen::Matrix4d::Identity()).norm(), 0, 1e-15);
  EXPECT_NEAR((poses[4].translation() - Eigen::Vector3d(0, 0.012, 0.016)).norm(), 0, 1e-15);
  s.turn_rad = 0.1;
  s.turn_centre_m = {0, 0, 0.3};
  poses = scanner_from_camera(s);
  for (const Pose& pose : poses)
    EXPECT_NEAR((pose * s.turn_centre_m - s.turn_centre_m).norm(), 0, 1e-15) << "the axis stays";
  EXPECT_NEAR(rotation_distance_rad(poses[0], poses[1]), 0.1, 1e-14);
}

TEST(LaserImages, AreTheSameOnAnyNumberOfThreads) {
  LaserLine s = small_laser();
  s.steps = 3;
  s.sensor = {.gain_e_per_dn = 10, .offset_dn = 20, .read_noise_e = 25, .bits = 10};
  const RayCaster caster(white_scene({sphere_at({0, 0, 0.18}, 0.03), plane_at(0.25)}));
  expect_same_for_any_thread_count([&] {
    std::vector<std::uint16_t> all;
    const RawFrames frames = render(s, caster, Pose::Identity(), {3, 1}, sensor_effects).frames;
    for (const auto& image : std::get<StripeImages>(frames).images)
      all.insert(all.end(), image.pixels.begin(), image.pixels.end());
    for (const RayTruth& ray : true_rays(s, caster, Pose::Identity()))
      all.push_back(static_cast<std::uint16_t>(ray.object));
    return all;
  });
}

TEST(LaserImages, HaveReadNoiseInTheDark) {
  LaserLine s = small_laser();
  s.peak_electrons = 0;
  s.steps = 2;
  s.sensor = {.gain_e_per_dn = 2, .offset_dn = 100, .read_noise_e = 10, .bits = 12};
  const RawFrames frames =
      render(s, RayCaster(white_scene({plane_at(0.2)})), Pose::Identity(), {}, sensor_effects)
          .frames;
  const auto& images = std::get<StripeImages>(frames).images;
  double sum = 0, squares = 0;
  for (const auto& image : images)
    for (const double dn : image.pixels) {
      sum += dn;
      squares += dn * dn;
    }
  const double count = 2 * 160 * 120, mean = sum / count, variance = 25 + 1.0 / 12;
  EXPECT_NEAR(mean, 100, 4 * std::sqrt(variance / count));
  EXPECT_NEAR(squares / count - mean * mean, variance, 4 * variance * std::sqrt(2 / count));
  EXPECT_NE(images[0].pixels, images[1].pixels);
  std::set<std::vector<std::uint16_t>> rows;
  for (int row = 0; row < 120; ++row)
    rows.emplace(images[0].pixels.begin() + row * 160, images[0].pixels.begin() + (row + 1) * 160);
  EXPECT_EQ(rows.size(), 120u) << "each row has a stream of its own";
}

// R2 for the whole device: the world's offset changes no number.
TEST(LaserImages, AreTheSameFarFromTheOrigin) {
  LaserLine s = small_laser();
  const auto image_at = [&](double offset_m) {
    const Eigen::Vector3d offset(offset_m, offset_m, -offset_m);
    Scene scene = white_scene({sphere_at({0, 0, 0.1875}, 0.03125), plane_at(0.25)});
    for (Object& object : scene.objects) object.world_from_object.translation() += offset;
    const RawFrames frames =
        render(s, RayCaster(scene), make_pose(Eigen::Matrix3d::Identity(), offset), {}, noise_free)
            .frames;
    return std::get<StripeImages>(frames).images[0].pixels;
  };
  const auto near = image_at(0), far = image_at(0x1p20);
  int different = 0;
  for (std::size_t i = 0; i < near.size(); ++i) different += std::abs(near[i] - far[i]) > 1;
  EXPECT_EQ(different, 0);
}

TEST(LaserLineCheck, NamesFieldValueAndLimit) {
  EXPECT_EQ(complaint(small_laser()), "");
  LaserLine s = small_laser();
  s.baseline_m = -1;
  EXPECT_NE(complaint(s).find("laser_line/baseline_m"), std::string::npos);
  s = small_laser();
  s.triangulation_rad = 2;
  EXPECT_NE(complaint(s).find("triangulation_rad"), std::string::npos);
  s = small_laser();
  s.steps = 0;
  EXPECT_NE(complaint(s).find("steps"), std::string::npos);
  s = small_laser();
  s.min_range_m = 2;
  s.max_range_m = 1;
  EXPECT_NE(complaint(s).find("min_range_m"), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
