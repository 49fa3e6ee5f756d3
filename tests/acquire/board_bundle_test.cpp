// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/board_bundle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "libscan/acquire/board_start.h"
#include "libscan/core/error.h"
#include "tests/acquire/board_pictures.h"

namespace scan::calibrating {
namespace {

using test::bent_camera;
using test::held_boards;
using test::test_board;

TEST(ProjectWithDerivatives, AgreesWithProjectAndItsDifferences) {
  Camera camera = bent_camera();
  camera.k3 = 0.03;
  const Eigen::Vector3d x(0.12, -0.09, 0.4);
  const Projection seen = project_with_derivatives(camera, x);
  EXPECT_LT((seen.pixel - project(camera, x).value()).norm(), 1e-12);
  // Central differences: error h^2 f''' / 6 (1e-8 of the value) and rounding 1e-13 / h.
  for (int i = 0; i < 3; ++i) {
    const double h = 1e-6;
    const Eigen::Vector3d by = h * Eigen::Vector3d::Unit(i);
    const Eigen::Vector2d slope =
        (project(camera, x + by).value() - project(camera, x - by).value()) / (2 * h);
    EXPECT_LT((slope - seen.by_point.col(i)).norm(), 1e-6 * seen.by_point.norm());
  }
  for (int i = 0; i < camera_unknowns; ++i) {
    const double h = i < 4 ? 1e-2 : 1e-5;  // linear in each unknown: rounding only
    const CameraVector by = h * CameraVector::Unit(i);
    const auto at = [&](double sign) {
      return project(with_unknowns(camera, unknowns_of(camera) + sign * by), x).value();
    };
    EXPECT_LT(((at(1) - at(-1)) / (2 * h) - seen.by_camera.col(i)).norm(), 1e-7) << i;
  }
}

// One camera with noisy corners; OpenCV minimises the same squares and is the oracle.
TEST(BoardBundle, FindsWhatOpenCvFindsWithItsDeviations) {
  const Camera truth = bent_camera();
  RandomStream random(1, 0, 0);
  std::vector<BoardSighting> seen;
  for (const Pose& pose : held_boards(truth, test_board, 3, 8))
    seen.push_back(test::sighting(truth, test_board, pose, 0.1, random));
  Bundle bundle{.board_m = corners_m(test_board), .cameras = {first_camera(test_board, seen)}};
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> pictures;
  for (BoardSighting& sighting : seen) {
    objects.emplace_back();
    for (const auto& x : bundle.board_m)
      objects.back().emplace_back(static_cast<float>(x.x()), static_cast<float>(x.y()), 0.0F);
    pictures.emplace_back();
    for (auto& corner : sighting.corners_px) {  // OpenCV takes floats: both get the same ones
      corner = corner.cast<float>().cast<double>();
      pictures.back().emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    }
    bundle.pictures.push_back(
        {{sighting.corners_px}, first_pose(bundle.cameras[0], test_board, sighting.corners_px)});
  }
  const BundleFit fit = adjust(bundle);
  EXPECT_TRUE(fit.converged);
  cv::Mat matrix, terms, deviations, unused, errors;
  std::vector<cv::Mat> turns, shifts;
  const double rms_px = cv::calibrateCamera(
      objects, pictures, {truth.width_px, truth.height_px}, matrix, terms, turns, shifts,
      deviations, unused, errors, cv::CALIB_FIX_K3,
      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-15));
  CameraVector theirs;
  theirs << matrix.at<double>(0, 0), matrix.at<double>(1, 1), matrix.at<double>(0, 2),
      matrix.at<double>(1, 2), terms.at<double>(0), terms.at<double>(1), terms.at<double>(2),
      terms.at<double>(3), 0;
  const CameraVector difference = unknowns_of(fit.bundle.cameras[0]) - theirs;
  // OpenCV 4.6 divides the squares by points less unknowns, where coordinates (twice as many) less
  // unknowns belong: 376 for 808.
  const double coordinates = 2.0 * 8 * 54, unknowns = 8 + 6 * 8;
  const double factor = std::sqrt((coordinates / 2 - unknowns) / (coordinates - unknowns));
  for (int i = 0; i < 8; ++i) {
    const double sigma = fit.sigma_px * std::sqrt(fit.cofactor(i, i));
    // Board points as floats are off by 6e-9 of 0.2 m: 1e-5 px, a ten-thousandth of the noise.
    EXPECT_LT(std::abs(difference[i]), 0.01 * sigma) << i;
    EXPECT_NEAR(factor * deviations.at<double>(i), sigma, 0.01 * sigma) << i;
  }
  EXPECT_NEAR(fit.rms_px, rms_px, 1e-6);
}

double rms_px(const Bundle& bundle) {
  double sum = 0, count = 0;
  for (const BoardPicture& picture : bundle.pictures)
    for (std::size_t k = 0; k < bundle.board_m.size(); ++k, ++count)
      sum += (project(bundle.cameras[0], picture.first_from_board * bundle.board_m[k]).value() -
              picture.corners_px[0][k])
                 .squaredNorm();
  return std::sqrt(sum / count);
}

// Three pictures of a board with poses up to a radian off, where full steps lead astray.
std::vector<Bundle> far_guesses() {
  RandomStream random(4, 0, 0);
  const std::vector<Pose> poses = held_boards(bent_camera(), test_board, 3, 3);
  std::vector<Bundle> guesses;
  for (int i = 0; i < 50; ++i) {
    guesses.push_back({.board_m = corners_m(test_board), .cameras = {bent_camera()}});
    for (const Pose& pose : poses) {
      const BoardSighting seen = test::sighting(bent_camera(), test_board, pose, 0.1, random);
      const Eigen::Translation3d middle(pose * Eigen::Vector3d(0.08, 0.05, 0));
      Vector6 off;
      for (int k = 0; k < 6; ++k) off[k] = (k < 3 ? 1 : 0.1) * (2 * random.uniform() - 1);
      guesses.back().pictures.push_back(
          {{seen.corners_px}, middle * exp(off) * middle.inverse() * pose});
    }
  }
  return guesses;
}

// With the camera sought, too: none ends farther off than it began, as each step is taken only if
// it leads down.
TEST(BoardBundle, NeverEndsWorseThanItBegan) {
  for (const Bundle& guess : far_guesses()) EXPECT_LE(adjust(guess).rms_px, rms_px(guess));
}

// A step that is damped enough leads down from anywhere but a rest: where full steps lead up,
// damping grows until one does, and none is stuck.
TEST(BoardBundle, ComesToRestWhereFullStepsLeadAstray) {
  for (Bundle guess : far_guesses()) {
    guess.fixed_cameras = true;
    EXPECT_TRUE(adjust(guess).converged);
  }
}

// A guess that has corners behind the camera, where no pixel is, is of infinite cost: any step
// would be small beside it, but none is an end.
TEST(BoardBundle, CallsNoGuessBehindTheCameraConverged) {
  const Pose truth = test::held_board(bent_camera(), test_board, {450, 305}, 0.25, 0.4, 1);
  RandomStream random(1, 0, 0);
  const BoardSighting seen = test::sighting(bent_camera(), test_board, truth, 0, random);
  Bundle bundle{
      .board_m = corners_m(test_board), .cameras = {bent_camera()}, .fixed_cameras = true};
  bundle.pictures.push_back({{seen.corners_px}, Eigen::Translation3d(0, 0, -0.25) * truth});
  const BundleFit fit = adjust(bundle);
  EXPECT_TRUE(!fit.converged || std::isfinite(fit.rms_px));
}

// Near the solution the distance to it is squared by each step (damping falls tenfold with it):
// from a hundredth of a radian to rounding in a few.
TEST(BoardBundle, ConvergesInAFewSteps) {
  RandomStream random(2, 0, 0);
  Bundle bundle{.board_m = corners_m(test_board), .cameras = {bent_camera()}};
  for (const Pose& pose : held_boards(bent_camera(), test_board, 3, 6)) {
    const BoardSighting seen = test::sighting(bent_camera(), test_board, pose, 0, random);
    Vector6 off;
    for (int i = 0; i < 6; ++i) off[i] = (i < 3 ? 1e-2 : 1e-3) * random.normal();
    bundle.pictures.push_back({{seen.corners_px}, exp(off) * pose});
  }
  bundle.cameras[0].fx_px *= 1.03;
  const BundleFit fit = adjust(bundle);
  EXPECT_TRUE(fit.converged);
  EXPECT_LE(fit.iterations, 8);
  EXPECT_LT((unknowns_of(fit.bundle.cameras[0]) - unknowns_of(bent_camera())).norm(), 1e-6);
}

TEST(BoardBundle, NeedsMoreCoordinatesThanUnknowns) {
  Bundle bundle{.board_m = {Eigen::Vector3d::Zero()}, .cameras = {bent_camera()}};
  bundle.pictures.push_back({{{Eigen::Vector2d(1, 2)}}});
  EXPECT_THROW(adjust(bundle), Error);
}

}  // namespace
}  // namespace scan::calibrating
