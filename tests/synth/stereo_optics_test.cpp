// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/stereo_optics.h"

#include <cmath>
#include <numbers>

#include "tests/synth/stereo_images.h"

namespace scan::synth {
namespace {

// The mean over rows of a column's electrons, of a white plate from the left image edge to edge_px.
double column_mean(const StereoPair& pair, double z_m, double edge_px, int column) {
  const double edge_m = (edge_px - pair.calibration.cx_px) / focal_px * z_m;
  const Scene scene{.objects = {plate(z_m, -0.9 * z_m, edge_m)}, .materials = {plain(1)}};
  const RayCaster caster(scene);
  double sum = 0;
  const int rows = pair.calibration.height_px;
  for (int row = 0; row < rows; ++row)
    sum += expected_electrons(pair, caster, Pose::Identity(), StereoSide::left, column, row);
  return sum / rows / pair.ambient_electrons;
}

// Share of a disk of diameter 1 on one side of a line at x from its centre: the edge's image.
double disk_share(double x) {
  const double t = std::clamp(2 * x, -1.0, 1.0);
  return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / std::numbers::pi;
}

// A straight edge out of focus is spread by the blur disk and the pixel's own width. 64 lens points
// per pixel, turned anew from pixel to pixel, 32 rows: a point moves the share by 1 / 64, and
// between 64 points of a spiral the count of one side errs by about the square root of those near
// the line, 64^(1/4) = 3: 0.045 for one pixel, 0.008 for the mean of 32; four times that.
TEST(StereoOptics, BlursAnEdgeByTheCircleOfConfusion) {
  StereoPair pair = small_pair();
  pair.focus_m = 1;
  pair.aperture_m = 0.1;
  pair.sub_rays = 8;
  const double z_m = 2;
  const double diameter_px = blur_px(pair, z_m);
  EXPECT_DOUBLE_EQ(diameter_px, 0.1 * focal_px * 0.5);
  for (int column = 36; column <= 44; ++column) {
    double expected = 0;
    for (int i = 0; i < 100; ++i)
      expected += disk_share((40.25 - (column - 0.495 + 0.01 * i)) / diameter_px) / 100;
    EXPECT_NEAR(column_mean(pair, z_m, 40.25, column), expected, 0.032) << column;
  }
}

TEST(StereoOptics, IsSharpInThePlaneOfFocus) {
  StereoPair pair = small_pair();
  pair.focus_m = 2;
  pair.aperture_m = 0.1;
  EXPECT_DOUBLE_EQ(column_mean(pair, 2, 40.5, 40), 1);
  EXPECT_DOUBLE_EQ(column_mean(pair, 2, 40.5, 41), 0);
}

TEST(StereoOptics, DarkensByTheFourthPowerOfTheCosine) {
  StereoPair pair = small_pair();
  const Scene scene{.objects = {plane_at(1)}, .materials = {plain(1)}};
  const RayCaster caster(scene);
  pair.sub_rays = 1;
  for (const double share : {0.0, 0.5, 1.0}) {
    pair.vignetting = share;
    const double u = (60 - 31.5) / focal_px, v = (3 - 15.5) / focal_px;
    const double cosine4 = 1 / std::pow(1 + u * u + v * v, 2);
    EXPECT_NEAR(expected_electrons(pair, caster, Pose::Identity(), StereoSide::left, 60, 3),
                3000 * (1 - share + share * cosine4), 1e-9);
  }
}

// Row by row the moving pair sees what a pair standing at the row's place sees.
TEST(StereoOptics, ExposesRowsOneAfterTheOther) {
  StereoPair pair = small_pair();
  pair.velocity_m_s = {0.3, 0.1, -0.2};
  pair.angular_velocity_rad_s = {0.2, -0.1, 0.4};
  pair.row_time_s = 1e-3;
  const Scene scene{.objects = {plane_at(1)}, .materials = {noisy(0.05, 4)}};
  const RayCaster caster(scene);
  const StereoPair standing = small_pair();
  for (const int row : {0, 7, 31}) {
    const Pose pose = moved(pair, 1e-3 * (row - 15.5));
    for (const StereoSide side : {StereoSide::left, StereoSide::right})
      EXPECT_DOUBLE_EQ(expected_electrons(pair, caster, Pose::Identity(), side, 20, row),
                       expected_electrons(standing, caster, pose, side, 20, row));
  }
  Vector6 twist = Vector6::Zero();
  twist.head<3>() = pair.angular_velocity_rad_s * 0.5;
  EXPECT_TRUE(moved(pair, 0.5).linear().isApprox(exp(twist).linear(), 1e-15));
  EXPECT_TRUE(moved(pair, 0.5).translation().isApprox(pair.velocity_m_s * 0.5, 1e-15));
}

// An edge that moves by 8 px during the exposure becomes a ramp of 8 px; 64 instants share it.
TEST(StereoOptics, SmearsWhatMovesDuringAnExposure) {
  StereoPair pair = small_pair();
  pair.sub_rays = 8;
  pair.velocity_m_s = {1, 0, 0};
  pair.exposure_s = 8 / focal_px;
  for (int column = 34; column <= 46; ++column) {
    const double ramp = std::clamp((44.5 - column) / 8.0, 0.0, 1.0);
    EXPECT_NEAR(column_mean(pair, 1, 40.5, column), ramp, 1.0 / 64 + 0.5 / 8 * 0.5) << column;
  }
}

TEST(StereoOptics, TurnsTheRightCameraByItsError) {
  StereoPair pair = small_pair();
  pair.sub_rays = 1;
  pair.right_rotation_error_rad = {0, 0.01, 0};
  pair.right_position_error_m = {0.001, 0.002, 0};
  const ScannerRay seen = stereo_ray(pair, StereoSide::right, 20, 9, 0).ray;
  const ScannerRay believed = calibrated_ray(pair.calibration, StereoSide::right, {20, 9});
  EXPECT_TRUE((seen.origin - believed.origin).isApprox(pair.right_position_error_m, 1e-12));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_TRUE(seen.direction.isApprox(turn * believed.direction, 1e-12));
  const ScannerRay left = stereo_ray(pair, StereoSide::left, 20, 9, 0).ray;
  EXPECT_EQ(left.origin, Eigen::Vector3d::Zero().eval());
}

TEST(StereoOptics, BecomesIdealWithoutEffects) {
  StereoPair pair = small_pair();
  pair.aperture_m = 0.01;
  pair.vignetting = 1;
  pair.row_time_s = pair.exposure_s = 1e-3;
  pair.velocity_m_s = {1, 0, 0};
  pair.right_rotation_error_rad = {0.01, 0, 0};
  const StereoPair ideal = with_effects(pair, {});
  const Scene scene{.objects = {plane_at(1)}, .materials = {noisy(0.05, 4)}};
  StereoPair plainly = small_pair();
  plainly.sub_rays = 1;
  for (const StereoSide side : {StereoSide::left, StereoSide::right})
    EXPECT_EQ(mean_image(ideal, scene, side).pixels, mean_image(plainly, scene, side).pixels);
}

}  // namespace
}  // namespace scan::synth
