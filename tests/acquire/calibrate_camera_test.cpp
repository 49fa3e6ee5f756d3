// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/calibrate_camera.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "libscan/acquire/board_bundle.h"
#include "libscan/core/error.h"
#include "tests/acquire/board_pictures.h"

namespace scan {
namespace {

using calibrating::unknowns_of;
using test::bent_camera;
using test::held_board;
using test::held_boards;
using test::picture_of;
using test::test_board;

std::vector<BoardSighting> sightings(const std::vector<Pose>& poses, double sigma_px,
                                     std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  std::vector<BoardSighting> seen;
  for (const Pose& pose : poses)
    seen.push_back(test::sighting(bent_camera(), test_board, pose, sigma_px, random));
  return seen;
}

Eigen::Matrix<double, 8, 1> error_of(const CameraCalibration& found) {
  return (unknowns_of(found.camera) - unknowns_of(bent_camera())).head<8>();
}

std::string message_of(const std::vector<BoardSighting>& seen, Trouble trouble) {
  try {
    calibrate_camera(test_board, seen);
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), trouble);
    return error.what();
  }
  return "";
}

// The normalised error squared of 8 unknowns over 100 sets of pictures: 800 in the mean, standard
// deviation sqrt(2 * 800) = 40 (sigma comes from 860 degrees of freedom: nothing beside). 4 sigma.
TEST(CalibrateCamera, ErrorsAreAsLargeAsTheCovarianceSays) {
  constexpr int sets = 100;
  double sum = 0, sigma_px = 0;
  for (int seed = 0; seed < sets; ++seed) {
    const auto poses = held_boards(bent_camera(), test_board, 100 + seed, 10);
    const CameraCalibration found =
        calibrate_camera(test_board, sightings(poses, 0.2, 1000 + seed));
    const auto error = error_of(found);
    sum += error.dot(found.covariance.topLeftCorner<8, 8>().ldlt().solve(error));
    sigma_px += found.sigma_px / sets;
  }
  EXPECT_NEAR(sum, 8 * sets, 4 * std::sqrt(2.0 * 8 * sets));
  // each is known to 0.2 / sqrt(2 * 1012) px, their mean to a tenth of that: 4 sigma
  EXPECT_NEAR(sigma_px, 0.2, 4 * 0.2 / std::sqrt(2.0 * 1012 * sets));
}

// Repeating the same poses n times divides the variance by n.
TEST(CalibrateCamera, SigmaFallsWithTheRootOfThePictures) {
  const auto poses = held_boards(bent_camera(), test_board, 7, 6);
  std::vector<Pose> fourfold;
  for (int i = 0; i < 4; ++i) fourfold.insert(fourfold.end(), poses.begin(), poses.end());
  const auto few = calibrate_camera(test_board, sightings(poses, 0.1, 1));
  const auto many = calibrate_camera(test_board, sightings(fourfold, 0.1, 2));
  for (int i = 0; i < 8; ++i) {
    const double ratio = std::sqrt(few.covariance(i, i) / many.covariance(i, i));
    // sigma_px of the few is known to 1 / sqrt(2 * 604) = 3 %; the places of the derivatives move
    // by a hundredth of that
    EXPECT_NEAR(ratio, 2, 2 * 4 * 0.03) << i;
  }
}

TEST(CalibrateCamera, TermsThatAreNotSoughtStayZero) {
  const auto seen = sightings(held_boards(bent_camera(), test_board, 7, 6), 0.1, 1);
  const auto found = calibrate_camera(test_board, seen, {.distortion_terms = 2});
  EXPECT_EQ(found.camera.p1, 0);
  EXPECT_EQ(found.camera.k3, 0);
  EXPECT_EQ(found.covariance(6, 6), 0);
  EXPECT_NE(found.camera.k2, 0);
}

// Corners found in pictures: their errors are no normal noise but the finder's own, and a
// chi-square of 8 degrees of freedom stays below 26 in 999 of 1000 cases.
TEST(CalibrateCamera, RecoversTheCameraFromPictures) {
  const auto poses = held_boards(bent_camera(), test_board, 11, 10);
  std::vector<BoardSighting> seen;
  for (std::size_t i = 0; i < poses.size(); ++i)
    seen.push_back(
        find_board(picture_of(bent_camera(), test_board, poses[i], 0.7, 2, i), test_board));
  const CameraCalibration found = calibrate_camera(test_board, seen);
  const auto error = error_of(found);
  const double chi2 = error.dot(found.covariance.topLeftCorner<8, 8>().ldlt().solve(error));
  RecordProperty("chi2", std::to_string(chi2));
  RecordProperty("sigma_px", std::to_string(found.sigma_px));
  EXPECT_LT(chi2, 26);
  EXPECT_LT(found.sigma_px, 0.05);
  EXPECT_GT(found.coverage, 0.6);
}

TEST(CalibrateCamera, RefusesOneFrontoParallelPicture) {
  const Pose pose = held_board(bent_camera(), test_board, {395, 305}, 0.3, 0, 0);
  for (const double sigma_px : {0.0, 0.1}) {
    const std::string message = message_of(sightings({pose}, sigma_px, 3), Trouble::computation);
    EXPECT_NE(message.find("undetermined"), std::string::npos) << message;
  }
}

// Nine boards that are all turned alike.
std::vector<Pose> parallel_boards(double tilt_rad) {
  const Pose tilted = held_board(bent_camera(), test_board, {395, 305}, 0.3, tilt_rad, 1);
  std::vector<Pose> poses;
  for (const double column : {250.0, 395.0, 540.0})
    for (const double row : {210.0, 305.0, 400.0}) {
      poses.push_back(held_board(bent_camera(), test_board, {column, row}, 0.32, 0, 0));
      poses.back().linear() = tilted.linear();
    }
  return poses;
}

// Parallel boards share their vanishing line: two conditions for four unknowns (Zhang 2000,
// section 4), however many there are and whatever their noise.
TEST(CalibrateCamera, RefusesParallelBoards) {
  for (int seed = 0; seed < 10; ++seed) {
    const std::string message =
        message_of(sightings(parallel_boards(0), 0.1, 20 + seed), Trouble::computation);
    EXPECT_NE(message.find("undetermined"), std::string::npos) << seed;
  }
  Camera straight = bent_camera();
  straight.k1 = straight.k2 = straight.p1 = straight.p2 = 0;
  RandomStream random(1, 0, 0);
  std::vector<BoardSighting> seen;
  for (const Pose& pose : parallel_boards(0.5))
    seen.push_back(test::sighting(straight, test_board, pose, 0.1, random));
  EXPECT_THROW(calibrate_camera(test_board, seen, {.distortion_terms = 0}), Error);
}

// A bent picture tells its centre by itself, and tilted boards the rest: less well, by so much as
// the covariance says. Limit as above, of 50 sets.
TEST(CalibrateCamera, KnowsWhatDistortionTellsOfParallelBoards) {
  constexpr int sets = 50;
  double sum = 0;
  for (int seed = 0; seed < sets; ++seed) {
    const auto found =
        calibrate_camera(test_board, sightings(parallel_boards(0.5), 0.1, 50 + seed));
    const auto error = error_of(found);
    sum += error.dot(found.covariance.topLeftCorner<8, 8>().ldlt().solve(error));
  }
  EXPECT_NEAR(sum, 8 * sets, 4 * std::sqrt(2.0 * 8 * sets));
}

TEST(CalibrateCamera, NamesTheShareThatBoardsCover) {
  const Pose far = held_board(bent_camera(), test_board, {395, 305}, 0.8, 0, 0);
  // 8 x 5 squares of 0.02 m at 0.8 m: 180 x 113 px of 800 x 600
  const auto seen = sightings({far}, 0, 1);
  EXPECT_NEAR(calibrating::coverage(test_board, seen, std::vector<std::size_t>{0}),
              180.0 * 113 / (800 * 600), 0.005);
}

// A focal length off by 1 px moves the pixel of a ray by its column's distance from the centre in
// units of the focal length: most at the left border, 404 px away, and nothing downwards.
TEST(CalibrateCamera, NamesTheLargestSigmaOfARay) {
  Camera straight = bent_camera();
  straight.k1 = straight.k2 = straight.p1 = straight.p2 = 0;
  straight.cx_px = 404;  // 395 from the right border
  CameraCovariance covariance = CameraCovariance::Zero();
  covariance(0, 0) = 4;
  EXPECT_NEAR(calibrating::largest_ray_sigma_px(straight, covariance), 2 * 404.0 / 900, 1e-12);
  covariance(3, 3) = 9;
  EXPECT_NEAR(calibrating::largest_ray_sigma_px(straight, covariance), 3, 1e-12);
}

TEST(CalibrateCamera, LeavesOutAPictureOfAnotherBoardAndSaysSo) {
  auto seen = sightings(held_boards(bent_camera(), test_board, 13, 8), 0.1, 1);
  for (auto& corner : seen[3].corners_px) corner.x() += 1.5 * std::sin(corner.y() / 30);
  seen[5] = {.width_px = 640, .height_px = 480, .corners_px = seen[5].corners_px};
  seen[6].left_out = "is blurred";
  const CameraCalibration found = calibrate_camera(test_board, seen);
  EXPECT_EQ(found.pictures[3].left_out, "its corners fit the others' camera too badly");
  EXPECT_EQ(found.pictures[5].left_out, "is 640 x 480 px, the others are 800 x 600 px");
  EXPECT_EQ(found.pictures[6].left_out, "is blurred");
  EXPECT_EQ(found.camera_from_board.size(), 5u);
  EXPECT_NEAR(found.sigma_px, 0.1, 0.02);
}

TEST(CalibrateCamera, SaysWhyNoPictureServes) {
  const BoardSighting other{
      .width_px = 800, .height_px = 600, .left_out = "shows a board of 8x5 inner corners, not 9x6"};
  EXPECT_EQ(message_of({other, other}, Trouble::input),
            "calibration: none of 2 pictures can be used for a board of 9x6; the first shows a "
            "board of 8x5 inner corners, not 9x6");
}

}  // namespace
}  // namespace scan
