// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/calibrate_stereo.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "libscan/acquire/board_bundle.h"
#include "libscan/acquire/stereo.h"
#include "libscan/core/error.h"
#include "tests/acquire/stereo_rig.h"

namespace scan {
namespace {

using calibrating::unknowns_of;
using test::leaning_rig;
using test::test_board;

std::vector<BoardPair> noisy_pairs(double sigma_px, std::uint64_t seed) {
  const StereoRig rig = leaning_rig();
  RandomStream random(seed, 0, 0);
  std::vector<BoardPair> pairs;
  for (const Pose& pose : test::boards_in_sight_of_both(rig, 500 + seed, 10)) {
    BoardPair& pair = pairs.emplace_back();
    pair.left = test::sighting(rig.left, test_board, pose, sigma_px, random);
    pair.right =
        test::sighting(rig.right, test_board, rig.right_from_left * pose, sigma_px, random);
  }
  return pairs;
}

// Of the unknowns that are sought: 8 + 8 + 6.
Eigen::Matrix<double, 22, 1> error_of(const StereoRig& found) {
  const StereoRig truth = leaning_rig();
  Eigen::Matrix<double, 22, 1> error;
  error << (unknowns_of(found.left) - unknowns_of(truth.left)).head<8>(),
      (unknowns_of(found.right) - unknowns_of(truth.right)).head<8>(),
      log(found.right_from_left * truth.right_from_left.inverse());
  return error;
}

Eigen::Matrix<double, 22, 22> sought(const RigCovariance& covariance) {
  std::vector<int> indices;
  for (int i = 0; i < 24; ++i)
    if (i != 8 && i != 17) indices.push_back(i);
  return covariance(indices, indices);
}

// One unknown moved, in the covariance's order.
StereoRig moved(StereoRig rig, int unknown, double by) {
  if (unknown >= 18) {
    rig.right_from_left = exp(by * Vector6::Unit(unknown - 18)) * rig.right_from_left;
    return rig;
  }
  Camera& camera = unknown < 9 ? rig.left : rig.right;
  const calibrating::CameraVector step = by * calibrating::CameraVector::Unit(unknown % 9);
  camera = calibrating::with_unknowns(camera, unknowns_of(camera) + step);
  return rig;
}

// Depth along a left pixel's ray at which the right camera sees a column: bisection.
double seen_depth_m(const StereoRig& rig, const Eigen::Vector2d& left, double right_column) {
  const Eigen::Vector3d ray = ray_through(rig.left, left).value();
  double near_m = 0.1, far_m = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle_m = (near_m + far_m) / 2;
    const auto right = project(rig.right, rig.right_from_left * (middle_m * ray)).value();
    (right.x() > right_column ? far_m : near_m) = middle_m;
  }
  return near_m;
}

// What the calibration's covariance says of the depth that it finds for a point.
double depth_sigma_m(const RigCalibration& found, const Eigen::Vector3d& x_in_left) {
  const StereoRig& rig = found.rig;
  const Eigen::Vector2d left = project(rig.left, x_in_left).value();
  const double column = project(rig.right, rig.right_from_left * x_in_left)->x();
  Eigen::Matrix<double, 24, 1> slope;
  for (int i = 0; i < 24; ++i) {
    const double h = 1e-3 * std::max(std::sqrt(found.covariance(i, i)), 1e-9);
    slope[i] = (seen_depth_m(moved(rig, i, h), left, column) -
                seen_depth_m(moved(rig, i, -h), left, column)) /
               (2 * h);
  }
  return std::sqrt(slope.dot(found.covariance * slope));
}

// Chi-square of 22 unknowns over 50 sets: 1100, standard deviation sqrt(2200). 4 sigma. The
// baseline's own deviation: mean square 1, standard deviation sqrt(2 / 50).
TEST(CalibrateStereo, ErrorsAreAsLargeAsTheCovarianceSays) {
  constexpr int sets = 50;
  double sum = 0, baseline = 0, epipolar_px = 0;
  for (int seed = 0; seed < sets; ++seed) {
    const RigCalibration found = calibrate_stereo(test_board, noisy_pairs(0.1, seed));
    const auto error = error_of(found.rig);
    sum += error.dot(sought(found.covariance).ldlt().solve(error));
    const double off_m = found.baseline_m - leaning_rig().right_from_left.translation().norm();
    baseline += off_m * off_m / (found.baseline_sigma_m * found.baseline_sigma_m) / sets;
    epipolar_px += found.epipolar_rms_px / sets;
  }
  EXPECT_NEAR(sum, 22 * sets, 4 * std::sqrt(2.0 * 22 * sets));
  EXPECT_NEAR(baseline, 1, 4 * std::sqrt(2.0 / sets));
  // the noise of a right corner and that of the left one's line, 0.1 px each; 27000 corners, and
  // focal lengths that differ by 1 %
  EXPECT_NEAR(epipolar_px, 0.1 * std::sqrt(2.0), 0.004);
}

// OpenCV minimises the same squares over the same unknowns.
TEST(CalibrateStereo, FindsWhatOpenCvFinds) {
  auto pairs = noisy_pairs(0.1, 3);
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> left, right;
  for (BoardPair& pair : pairs) {
    objects.emplace_back(), left.emplace_back(), right.emplace_back();
    for (const auto& x : corners_m(test_board))
      objects.back().emplace_back(static_cast<float>(x.x()), static_cast<float>(x.y()), 0.0F);
    for (auto [side, points] : {std::pair{&pair.left, &left}, {&pair.right, &right}})
      for (Eigen::Vector2d& corner : side->corners_px) {
        corner = corner.cast<float>().cast<double>();
        points->back().emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
      }
  }
  const RigCalibration found = calibrate_stereo(test_board, pairs);
  cv::Mat matrix[2], terms[2], turn, shift, essential, fundamental;
  std::vector<cv::Mat> turns, shifts;
  for (int i = 0; i < 2; ++i)
    cv::calibrateCamera(objects, i == 0 ? left : right, {800, 600}, matrix[i], terms[i], turns,
                        shifts, cv::CALIB_FIX_K3);
  cv::stereoCalibrate(
      objects, left, right, matrix[0], terms[0], matrix[1], terms[1], {800, 600}, turn, shift,
      essential, fundamental, cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_K3,
      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 300, 1e-14));
  for (int i = 0; i < 3; ++i) {
    const double sigma_m = std::sqrt(found.covariance(21 + i, 21 + i));
    EXPECT_NEAR(found.rig.right_from_left.translation()[i], shift.at<double>(i), 0.05 * sigma_m);
  }
  EXPECT_NEAR(found.rig.left.fx_px, matrix[0].at<double>(0, 0),
              0.05 * std::sqrt(found.covariance(0, 0)));
}

// A wavy picture on a plane, seen by both cameras as they are; calibrated from pictures of the
// board, rectified, matched.
TEST(CalibrateStereo, MakesAPairThatMeasuresAPlaneWhereItIs) {
  const StereoRig truth = leaning_rig();
  std::vector<BoardPair> pairs;
  const auto boards = test::boards_in_sight_of_both(truth, 21, 6);
  const auto found_in = [&](const Camera& camera, const Pose& pose, std::uint64_t seed) {
    return find_board(test::picture_of(camera, test_board, pose, 0.7, 2, seed), test_board);
  };
  for (std::size_t i = 0; i < boards.size(); ++i)
    pairs.push_back({found_in(truth.left, boards[i], i),
                     found_in(truth.right, truth.right_from_left * boards[i], 100 + i)});
  const RigCalibration found = calibrate_stereo(test_board, pairs);
  double nearest_m = 1e9, farthest_m = 0;
  for (const Pose& pose : boards)
    for (const Eigen::Vector3d& corner : corners_m(test_board)) {
      nearest_m = std::min(nearest_m, (pose * corner).z());
      farthest_m = std::max(farthest_m, (pose * corner).z());
    }
  EXPECT_NEAR(found.nearest_m, nearest_m, 0.005);  // boards stand 0.3 m off, known to a hundredth
  EXPECT_NEAR(found.farthest_m, farthest_m, 0.005);
  const auto error = error_of(found.rig);
  const double chi2 = error.dot(sought(found.covariance).ldlt().solve(error));
  RecordProperty("chi2", std::to_string(chi2));
  EXPECT_LT(chi2, 48.3);  // 999 of 1000 at 22 degrees of freedom

  const Pose wall = test::held_board(truth.left, test_board, {420, 300}, 0.32, 0.3, 1);
  const Rectification turned = rectify(found.rig, 0.24, 0.45);
  const Scan scan =
      acquire_stereo(rectify(turned, test::wavy_wall(truth.left, wall),
                             test::wavy_wall(truth.right, truth.right_from_left * wall)));
  ASSERT_GT(scan.cloud.size(), 200000u);
  std::vector<double> off_m;
  const Eigen::Vector3d normal = wall.linear().col(2);
  for (const Eigen::Vector3d& point : scan.cloud.points)
    off_m.push_back(
        normal.dot(turned.rectified_from_left.transpose() * point - wall.translation()));
  std::nth_element(off_m.begin(), off_m.begin() + off_m.size() / 2, off_m.end());
  const double median_m = off_m[off_m.size() / 2];
  RecordProperty("median_um", std::to_string(1e6 * median_m));
  RecordProperty("sigma_px", std::to_string(found.sigma_px));
  // The calibration's error at the middle of the wall, four sigma. What stereo itself is off there
  // is less than a twentieth of a pixel, 1.9 mm of depth a pixel.
  const double sigma_m = depth_sigma_m(found, wall * Eigen::Vector3d(0.08, 0.05, 0));
  RecordProperty("sigma_um", std::to_string(1e6 * sigma_m));
  EXPECT_LT(std::abs(median_m), 4 * sigma_m + 0.05 * 1.9e-3);
}

TEST(CalibrateStereo, SaysWhichPictureOfAPairFailed) {
  auto pairs = noisy_pairs(0.1, 1);
  pairs[2].right = {.width_px = 800, .height_px = 600, .left_out = "is blurred"};
  pairs[4].left.left_out = "shows no board";
  const RigCalibration found = calibrate_stereo(test_board, pairs);
  EXPECT_EQ(found.pairs[2].left_out, "right picture is blurred");
  EXPECT_EQ(found.pairs[4].left_out, "left picture shows no board");
  EXPECT_GT(found.pairs[3].rms_px, 0.05);
}

// The left pictures given twice, as by a slip in a shell pattern: cameras at one place.
TEST(CalibrateStereo, RefusesTwoEyesAtOnePlace) {
  auto pairs = noisy_pairs(0.1, 1);
  for (BoardPair& pair : pairs) pair.right = pair.left;
  try {
    calibrate_stereo(test_board, pairs);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::computation);
    EXPECT_TRUE(std::string(error.what()).starts_with("stereo rig: its baseline is 0 um"))
        << error.what();
  }
}

TEST(CalibrateStereo, WantsABoardWithOneOrientation) {
  try {
    calibrate_stereo({.columns = 8, .rows = 6, .square_m = 0.02}, noisy_pairs(0.1, 1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::usage);
  }
}

}  // namespace
}  // namespace scan
