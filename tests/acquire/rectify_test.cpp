// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/rectify.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "tests/acquire/stereo_rig.h"

namespace scan {
namespace {

using test::leaning_rig;

// Where the rectified pictures show a point of the left camera's frame.
Eigen::Vector2d turned_pixel(const Eigen::Matrix3d& turn, const Eigen::Vector3d& x_in_camera,
                             double focal_px, double cx_px, double cy_px) {
  return focal_px * (turn * x_in_camera).hnormalized() + Eigen::Vector2d(cx_px, cy_px);
}

// The stereo model itself: one row, and Z = f B / (d + doffs).
TEST(Rectify, PutsPointsIntoOneRowAtTheirDepth) {
  const StereoRig rig = leaning_rig();
  const Rectification turned = rectify(rig, 0.2, 0.6);
  const StereoCalibration& c = turned.calibration;
  EXPECT_NEAR(c.baseline_m, rig.right_from_left.translation().norm(), 1e-15);
  for (const Eigen::Vector3d& x : {Eigen::Vector3d(0.05, -0.04, 0.3), {-0.02, 0.07, 0.5}}) {
    const auto left = turned_pixel(turned.rectified_from_left, x, c.focal_px, c.cx_px, c.cy_px);
    const auto right = turned_pixel(turned.rectified_from_right, rig.right_from_left * x,
                                    c.focal_px, c.cx_px + c.doffs_px, c.cy_px);
    EXPECT_NEAR(left.y(), right.y(), 1e-10);
    const double disparity_px = left.x() - right.x();
    EXPECT_NEAR(c.focal_px * c.baseline_m / (disparity_px + c.doffs_px),
                (turned.rectified_from_left * x).z(), 1e-13);
    EXPECT_GE(disparity_px, c.min_disparity_px);
    EXPECT_LE(disparity_px, c.min_disparity_px + c.disparities_px);
  }
}

// Both pictures keep their middle columns, the pair its middle row: what was seen is seen still.
TEST(Rectify, KeepsTheMiddleInTheMiddle) {
  const StereoRig rig = leaning_rig();
  const Rectification turned = rectify(rig, 0.2, 0.6);
  const StereoCalibration& c = turned.calibration;
  const Eigen::Vector2d middle((c.width_px - 1) / 2.0, (c.height_px - 1) / 2.0);
  const Eigen::Vector2d left =
      (turned.rectified_from_left * ray_through(rig.left, middle).value()).hnormalized();
  const Eigen::Vector2d right =
      (turned.rectified_from_right * ray_through(rig.right, middle).value()).hnormalized();
  EXPECT_NEAR(c.focal_px * left.x() + c.cx_px, middle.x(), 1e-9);
  EXPECT_NEAR(c.focal_px * right.x() + c.cx_px + c.doffs_px, middle.x(), 1e-9);
  EXPECT_NEAR(c.focal_px * (left.y() + right.y()) / 2 + c.cy_px, middle.y(), 1e-9);
  EXPECT_GT(std::abs(c.doffs_px), 1);  // or its sign would not show
}

TEST(Rectify, LeavesAPairThatIsRectifiedAlone) {
  StereoRig rig;
  rig.left = {
      .width_px = 64, .height_px = 48, .fx_px = 80, .fy_px = 80, .cx_px = 31.5, .cy_px = 23.5};
  rig.right = rig.left;
  rig.right_from_left.translation() = Eigen::Vector3d(-0.1, 0, 0);
  const Rectification turned = rectify(rig, 0.5, 2);
  EXPECT_TRUE(turned.rectified_from_left.isIdentity(1e-15));
  EXPECT_EQ(turned.calibration.cx_px, 31.5);
  EXPECT_EQ(turned.calibration.doffs_px, 0);
  EXPECT_EQ(turned.calibration.min_disparity_px, 4);  // 80 * 0.1 / 2
  EXPECT_EQ(turned.calibration.disparities_px, 16 + 1 - 4);
  Image<std::uint8_t> left(64, 48), right(64, 48);
  for (std::size_t i = 0; i < left.pixels.size(); ++i) {
    left.pixels[i] = static_cast<std::uint8_t>(37 * i % 251);
    right.pixels[i] = static_cast<std::uint8_t>(41 * i % 241);
  }
  const ImagePair pair = rectify(turned, left, right);
  EXPECT_EQ(pair.left.pixels, left.pixels);
  EXPECT_EQ(pair.right.pixels, right.pixels);
}

// A smooth picture on a plane, taken by the bent left camera and by a pinhole in its turned place.
// Half way between pixels cubic convolution of a wave of w rad a pixel gives it
// 9/8 cos(w / 2) - 1/8 cos(3 w / 2) times: at 0.6 rad 0.997, 0.2 of 60 grey levels. The picture's
// rounding by half a level grows by 1.25 each way at most, 0.8; two more roundings, whole
// numbers: 2.
TEST(Rectify, ShowsWhatAPinholeWouldSee) {
  const StereoRig rig = leaning_rig();
  const Rectification turned = rectify(rig, 0.2, 0.6);
  const StereoCalibration& c = turned.calibration;
  const Camera pinhole{.width_px = c.width_px,
                       .height_px = c.height_px,
                       .fx_px = c.focal_px,
                       .fy_px = c.focal_px,
                       .cx_px = c.cx_px,
                       .cy_px = c.cy_px};
  const Pose wall = test::held_board(rig.left, test::test_board, {400, 300}, 0.3, 0.2, 1);
  const auto waves = [&](const Camera& camera, const Pose& pose) {
    Image<std::uint8_t> picture(camera.width_px, camera.height_px);
    for (int row = 0; row < camera.height_px; ++row)
      for (int column = 0; column < camera.width_px; ++column) {
        const Eigen::Vector2d at = test::on_board(
            camera, pose.inverse(), {static_cast<double>(column), static_cast<double>(row)});
        picture(column, row) = static_cast<std::uint8_t>(
            std::lround(127 + 60 * std::sin(1200 * at.x()) * std::cos(1200 * at.y())));
      }
    return picture;
  };
  const Image<std::uint8_t> taken = waves(rig.left, wall);
  const ImagePair pair = rectify(turned, taken, taken);
  const Image<std::uint8_t> ideal =
      waves(pinhole, make_pose(turned.rectified_from_left, Eigen::Vector3d::Zero()) * wall);
  int largest = 0, seen = 0;
  for (std::size_t i = 0; i < ideal.pixels.size(); ++i) {
    const Eigen::Vector2d pixel(static_cast<double>(i % 800), static_cast<double>(i / 800));
    const Eigen::Vector2d flat = (pixel - Eigen::Vector2d(c.cx_px, c.cy_px)) / c.focal_px;
    const Eigen::Vector2d at =
        project(rig.left, turned.rectified_from_left.transpose() * flat.homogeneous()).value();
    if (at.minCoeff() < 1 || at.x() > 797 || at.y() > 597) continue;  // the kernel's reach
    ++seen;
    largest = std::max(largest, std::abs(pair.left.pixels[i] - ideal.pixels[i]));
  }
  EXPECT_GT(seen, 400000);
  EXPECT_LE(largest, 2);
}

TEST(Rectify, RefusesRigsThatAreNoPair) {
  StereoRig swapped = leaning_rig();
  swapped.right_from_left = swapped.right_from_left.inverse();
  EXPECT_THROW(rectify(swapped, 0.2, 0.6), Error);
  EXPECT_THROW(rectify(leaning_rig(), 0.6, 0.2), Error);
  StereoRig sizes = leaning_rig();
  sizes.right.width_px = 640;
  EXPECT_THROW(rectify(sizes, 0.2, 0.6), Error);
  const Image<std::uint8_t> small(320, 240);
  EXPECT_THROW(rectify(rectify(leaning_rig(), 0.2, 0.6), small, small), Error);
}

}  // namespace
}  // namespace scan
