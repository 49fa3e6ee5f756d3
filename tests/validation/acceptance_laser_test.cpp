// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Acceptance figures of a laser line whose errors are known.
#include <array>
#include <numbers>

#include "tests/validation/acceptance_figures.h"

namespace scan::synth {
namespace {

LaserLine laser_line() {
  LaserLine device;
  device.camera = {
      .width_px = 160, .height_px = 20, .fx_px = 400, .fy_px = 400, .cx_px = 79.5, .cy_px = 9.5};
  device.beam_radius_m = 4e-4;
  device.steps = 11;
  device.step_m = 2e-3;
  return device;
}

// Of the face of a plane at the distance z_m, all that the sweep sees.
Points scanned_plane(
    const LaserLine& device, double z_m, const EffectSet& effects,
    const std::function<void(RawFrames&)>& change = [](RawFrames&) {}) {
  const Scene scene{.objects = {plane_at(z_m)}, .materials = {grey}};
  RawFrames frames = render(device, RayCaster(scene), Pose::Identity(), {}, effects).frames;
  change(frames);
  return acquire(frames).cloud.points;
}

// Noise-free readings are rounded to steps of half an electron, which moves a stripe's centre by at
// most (step / 2) sum |s| / N over its window (laser_line_range_test), some 5e-4 px; along a
// camera's ray z = B / (u + tan(a)), so that is z^2 / (f B) times as much in range, 0.4 um. The
// stripe's bias on a plane that faces the scanner is none.
TEST(Acceptance, OfAnIdealLaserLineIsRounding) {
  LaserLine device = laser_line();
  device.sensor = {.gain_e_per_dn = 0.5, .offset_dn = 8, .bits = 16};
  const double near_m = 0.175, far_m = 0.19;
  const auto rounding_m = [&](double z_m) {
    const double f_px = device.camera.fx_px;
    const double sigma_px =
        f_px * device.beam_radius_m / (2 * z_m * std::cos(device.triangulation_rad));
    const double window_px = 9 * sigma_px * sigma_px + 3 * sigma_px + 1;
    const double height_e = 0.5 * device.peak_electrons * 0.8;  // light falls off by less than that
    const double electrons = std::sqrt(2 * std::numbers::pi) * sigma_px * height_e;
    return 0.25 * window_px / electrons * z_m * z_m / (f_px * device.baseline_m);
  };
  const Points near = scanned_plane(device, near_m, no_effects),
               far = scanned_plane(device, far_m, no_effects);
  EXPECT_LT(value(flatness_errors(std::vector{near, far}), "flatness"), 2 * rounding_m(far_m));
  EXPECT_LT(
      std::abs(value(step_errors(std::vector{Step{far, near}}, far_m - near_m), "step_error")),
      rounding_m(near_m) + rounding_m(far_m));
}

// A baseline that is believed 0.1 % too long puts the light plane, whose offset is B cos(a), as
// much farther from the camera, and every range in it with it: a step of faces across the sight
// grows by 0.1 %.
TEST(Acceptance, ALongBaselineShowsInTheLasersStep) {
  const double near_m = 0.175, far_m = 0.19;
  const auto height_m = [&](double factor) {
    const auto change = [&](RawFrames& frames) {
      std::get<StripeImages>(frames).calibration.plane_offset_m *= factor;
    };
    const Step step{scanned_plane(laser_line(), far_m, no_effects, change),
                    scanned_plane(laser_line(), near_m, no_effects, change)};
    return far_m - near_m + value(step_errors(std::vector{step}, far_m - near_m), "step_error");
  };
  EXPECT_NEAR(height_m(1.001) / height_m(1), 1.001, 1e-9);
}

// The real light plane leaves the laser at a larger angle, x = B - z tan(a + t), and is decoded as
// x = B - z' tan(a): 1 / z' = 1 / z - (tan(a + t) - tan(a)) / B, whatever x. The step between two
// such planes is what the sheet shows. The stripe's own bias, some 5 um here
// (laser_line_range_test), is the same with and without the tilt but for its change over the
// stripe's move, a tenth.
TEST(Acceptance, ATiltedLightPlaneShowsInTheStep) {
  LaserLine device = laser_line();
  device.plane_turn_rad = 2e-3;
  const double near_m = 0.175, far_m = 0.19;
  const auto step_error_m = [&](const EffectSet& effects) {
    const Step step{scanned_plane(device, far_m, effects), scanned_plane(device, near_m, effects)};
    return value(step_errors(std::vector{step}, far_m - near_m), "step_error");
  };
  const auto seen_m = [&](double z_m) {
    const double turn = std::tan(device.triangulation_rad + device.plane_turn_rad) -
                        std::tan(device.triangulation_rad);
    return 1 / (1 / z_m - turn / device.baseline_m);
  };
  const double predicted_m = (seen_m(far_m) - seen_m(near_m)) - (far_m - near_m);
  EXPECT_GT(predicted_m, 1e-4);
  const double tilted_m = step_error_m({Effect::footprint, Effect::miscalibration});
  EXPECT_NEAR(tilted_m - step_error_m(no_effects), predicted_m, 1e-6);
}

// Two balls, one at either side of x = 0, and the spacing error of their points.
constexpr double ball_radius_m = 4e-3;

LaserLine ball_scanner() {
  LaserLine device = laser_line();
  device.camera.height_px = 30;
  device.camera.cy_px = 14.5;
  device.sensor = {.gain_e_per_dn = 0.5, .offset_dn = 8, .bits = 16};
  return device;
}

double spacing_error_m(const LaserLine& device, const std::array<Eigen::Vector3d, 2>& centres_m,
                       const std::function<Pose(const Pose&)>& believed_step) {
  Scene scene{.objects = {}, .materials = {grey}};
  for (const Eigen::Vector3d& centre_m : centres_m)
    scene.objects.push_back({.name = "ball",
                             .world_from_object = make_pose(Eigen::Matrix3d::Identity(), centre_m),
                             .geometry = Shape(SphereShape{ball_radius_m}),
                             .material = 0});
  RawFrames frames = render(device, RayCaster(scene), Pose::Identity(), {}, no_effects).frames;
  for (Pose& step : std::get<StripeImages>(frames).scanner_from_camera) step = believed_step(step);
  BallBar bar;
  for (const Eigen::Vector3d& x : acquire(frames).cloud.points)
    (x.x() < 0 ? bar.first : bar.second).push_back(x);
  EXPECT_GT(bar.first.size(), 60u);
  EXPECT_GT(bar.second.size(), 60u);
  return value(spacing_errors(std::vector{bar}, (centres_m[1] - centres_m[0]).norm()),
               "sphere_spacing_error");
}

// A stage whose steps are 100 ppm longer than its encoder says: what lies a length apart along it
// is seen as much farther apart. The balls lie a whole number of steps apart, so the head sees both
// alike, and whatever bends one bends the other. Images are the same; fits are good to 1e-9 of
// their size.
TEST(Acceptance, AStageOfLongStepsShowsInTheSpacing) {
  LaserLine device = ball_scanner();
  device.step_m = 1e-3;
  device.steps = 41;
  const double length_m = 20 * device.step_m;
  const std::array<Eigen::Vector3d, 2> centres_m = {Eigen::Vector3d(-length_m / 2, 0, 0.18),
                                                    Eigen::Vector3d(length_m / 2, 0, 0.18)};
  const auto seen_m = [&](double factor) {
    return spacing_error_m(device, centres_m, [&](const Pose& step) {
      return make_pose(step.linear(), factor * step.translation());
    });
  };
  EXPECT_NEAR(seen_m(1.0001) - seen_m(1), 1e-4 * length_m, 1e-10);
}

// A turntable that turns 100 ppm farther than its encoder says: balls at the distance R from the
// axis, an angle D apart, are seen 2 R sin(D / 2) apart with D 100 ppm larger. Both are as much
// wider along their way, which moves a fitted centre towards the axis by less than 1e-4 of the
// radius r, the largest move of a point, and so the spacing by 2e-4 r sin(D / 2).
TEST(Acceptance, ATurntableThatTurnsTooFarShowsInTheSpacing) {
  LaserLine device = ball_scanner();
  device.turn_rad = 2 * std::numbers::pi / 180;
  device.turn_centre_m = {0, 0, 0.22};
  device.steps = 51;
  const double axis_m = 0.04, apart_rad = 30 * device.turn_rad;
  const auto at = [&](double angle_rad) -> Eigen::Vector3d {
    return device.turn_centre_m +
           axis_m * Eigen::Vector3d(std::sin(angle_rad), 0, -std::cos(angle_rad));
  };
  const std::array<Eigen::Vector3d, 2> centres_m = {at(-apart_rad / 2), at(apart_rad / 2)};
  const auto seen_m = [&](double factor) {
    return spacing_error_m(device, centres_m, [&](const Pose& step) {
      Eigen::AngleAxisd turn(step.linear());
      turn.angle() *= factor;
      const Eigen::Matrix3d turned = turn.toRotationMatrix();
      return make_pose(turned, device.turn_centre_m - turned * device.turn_centre_m);
    });
  };
  const double predicted_m =
      2 * axis_m * (std::sin(1.0001 * apart_rad / 2) - std::sin(apart_rad / 2));
  EXPECT_NEAR(seen_m(1.0001) - seen_m(1), predicted_m,
              2e-4 * ball_radius_m * std::sin(apart_rad / 2));
}

}  // namespace
}  // namespace scan::synth
