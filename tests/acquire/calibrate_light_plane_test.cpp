// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/calibrate_light_plane.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "libscan/acquire/board_bundle.h"
#include "libscan/acquire/laser_line.h"
#include "libscan/core/error.h"
#include "tests/acquire/stripe_pictures.h"

namespace scan {
namespace {

using test::bent_camera;
using test::boards_in_light;
using test::held_board;
using test::held_boards;
using test::picture_of;
using test::sensor;
using test::stripe_column;
using test::stripe_picture;
using test::test_board;
using test::true_normal;
using test::true_offset_m;

StripeOnBoard seen_stripe(const Pose& pose, double corner_sigma_px, double stripe_sigma_px,
                          RandomStream& random) {
  StripeOnBoard seen{test::sighting(bent_camera(), test_board, pose, corner_sigma_px, random), {}};
  for (int row = 0; row < bent_camera().height_px; row += 4)
    if (const auto column = stripe_column(pose, row))
      seen.stripe.push_back(
          {{*column + stripe_sigma_px * random.normal(), row}, stripe_sigma_px, 1.5});
  return seen;
}

// Depth at which a device sees a pixel's point of the stripe, and its sigma by the joint
// covariance.
using LaserVector = Eigen::Matrix<double, 13, 1>;

LaserVector unknowns_of(const Camera& camera, const LightPlaneCalibration& plane) {
  LaserVector unknowns;
  unknowns << calibrating::unknowns_of(camera), plane.normal, plane.offset_m;
  return unknowns;
}

double depth_m(const LaserVector& unknowns, const Eigen::Vector2d& pixel) {
  const Camera camera = calibrating::with_unknowns(bent_camera(), unknowns.head<9>());
  return unknowns[12] / unknowns.segment<3>(9).dot(ray_through(camera, pixel).value());
}

double depth_sigma_m(const LaserVector& at, const LaserCovariance& covariance,
                     const Eigen::Vector2d& pixel) {
  LaserVector slope;
  for (int i = 0; i < 13; ++i) {
    const double h = 1e-4 * std::max(std::sqrt(covariance(i, i)), 1e-9);
    const LaserVector by = h * LaserVector::Unit(i);
    slope[i] = (depth_m(at + by, pixel) - depth_m(at - by, pixel)) / (2 * h);
  }
  return std::sqrt(slope.dot(covariance * slope));
}

Eigen::Vector3d normalised(const LightPlaneCalibration& found, Eigen::Matrix3d& covariance) {
  Eigen::Matrix<double, 3, 4> project;  // turns of the normal, and the distance at 0.3 m
  const Eigen::Vector3d across = true_normal.unitOrthogonal();
  const Eigen::Vector3d centre = Eigen::Vector3d(0, 0, 0.3);
  project << across.transpose(), 0, true_normal.cross(across).transpose(), 0, -centre.transpose(),
      1;
  Eigen::Vector4d error;
  error << found.normal - true_normal, found.offset_m - true_offset_m;
  covariance = project * found.covariance.bottomRightCorner<4, 4>() * project.transpose();
  return project * error;
}

// Chi-square of three unknowns over 100 sets: 300, standard deviation sqrt(600). 4 sigma.
TEST(CalibrateLightPlane, ErrorsAreAsLargeAsTheCovarianceSays) {
  constexpr int sets = 100;
  double sum = 0, misfit2 = 0;
  for (int seed = 0; seed < sets; ++seed) {
    RandomStream random(seed, 0, 0);
    std::vector<StripeOnBoard> seen;
    for (const Pose& pose : boards_in_light()) seen.push_back(seen_stripe(pose, 0.05, 0.1, random));
    const auto found =
        calibrate_light_plane(test_board, bent_camera(), CameraCovariance::Zero(), seen);
    Eigen::Matrix3d covariance;
    const Eigen::Vector3d error = normalised(found, covariance);
    sum += error.dot(covariance.ldlt().solve(error));
    misfit2 += found.misfit * found.misfit / sets;
  }
  EXPECT_NEAR(sum, 3 * sets, 4 * std::sqrt(6.0 * sets));
  // some 400 points a set: misfit^2 is known to sqrt(2 / 40000) = 0.007, its poses' sigma to 0.004
  EXPECT_NEAR(misfit2, 1, 0.04);
}

LightPlaneCalibration calibrated(double stated_sigma_px, double noise_px, std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  std::vector<StripeOnBoard> seen;
  for (const Pose& pose : boards_in_light()) {
    seen.push_back(seen_stripe(pose, 0, noise_px, random));
    for (StripePixel& pixel : seen.back().stripe) pixel.sigma_px = stated_sigma_px;
  }
  return calibrate_light_plane(test_board, bent_camera(), CameraCovariance::Zero(), seen);
}

// Stripes five times as noisy as they say, on boards known to the least sigma of a corner, 0.01 px:
// the misfit makes good for it. Chi-square as above; the boards' share of the covariance, which is
// inflated, too, lowers it by far less than the limit.
TEST(CalibrateLightPlane, NoiseThatIsNotStatedIsSeenInTheMisfit) {
  constexpr int sets = 100;
  double sum = 0;
  for (int seed = 0; seed < sets; ++seed) {
    const auto found = calibrated(0.1, 0.5, seed);
    Eigen::Matrix3d covariance;
    const Eigen::Vector3d error = normalised(found, covariance);
    sum += error.dot(covariance.ldlt().solve(error));
  }
  EXPECT_NEAR(sum, 3 * sets, 4 * std::sqrt(6.0 * sets));
}

// Stripes quieter than they say are chance or the board's evenness, not a better device: without
// noise the deviations are those of the stated sigma, twice as much for twice that, boards aside.
TEST(CalibrateLightPlane, ASmallMisfitPromisesNothing) {
  const auto quiet = calibrated(1, 0, 1), twice = calibrated(2, 0, 1);
  ASSERT_LT(quiet.misfit, 0.1);
  Eigen::Matrix3d one, four;
  normalised(quiet, one);
  normalised(twice, four);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(four(i, i) / one(i, i), 4, 0.1);
}

// Camera and plane from noisy pictures of the same board: depths of a plane at 0.3 m, read by the
// calibrated device, are off by what the joint covariance says. Their normalised squares have mean
// 1; over 60 sets (points of one set share their error) the standard deviation is sqrt(2 / 60).
TEST(CalibrateLightPlane, DepthsAreOffByWhatTheJointCovarianceSays) {
  constexpr int sets = 60;
  const Eigen::Vector2d pixel(420, 150);
  const double true_depth_m =
      true_offset_m / true_normal.dot(ray_through(bent_camera(), pixel).value());
  double sum = 0;
  for (int seed = 0; seed < sets; ++seed) {
    RandomStream random(seed, 0, 0);
    std::vector<BoardSighting> boards;
    for (const Pose& pose : held_boards(bent_camera(), test_board, 300 + seed, 10))
      boards.push_back(test::sighting(bent_camera(), test_board, pose, 0.1, random));
    const CameraCalibration camera = calibrate_camera(test_board, boards);
    std::vector<StripeOnBoard> seen;
    for (const Pose& pose : boards_in_light()) seen.push_back(seen_stripe(pose, 0.1, 0.1, random));
    const auto found = calibrate_light_plane(test_board, camera.camera, camera.covariance, seen);
    const LaserVector at = unknowns_of(camera.camera, found);
    const double score =
        (depth_m(at, pixel) - true_depth_m) / depth_sigma_m(at, found.covariance, pixel);
    sum += score * score;
  }
  EXPECT_NEAR(sum / sets, 1, 4 * std::sqrt(2.0 / sets));
}

// From pictures: board and stripe rendered, both found, and a plane scanned with the result.
TEST(CalibrateLightPlane, MakesADeviceThatMeasuresAPlaneWhereItIs) {
  const auto board_light = [](const Eigen::Vector2d& at) {
    return test::board_reflectance(test_board, at.x(), at.y());
  };
  std::vector<BoardSighting> boards;
  std::vector<StripeOnBoard> seen;
  const auto held = held_boards(bent_camera(), test_board, 11, 8);
  for (std::size_t i = 0; i < held.size(); ++i)
    boards.push_back(
        find_board(picture_of(bent_camera(), test_board, held[i], 0.7, 2, i), test_board));
  const CameraCalibration camera = calibrate_camera(test_board, boards);
  const auto lit = boards_in_light();
  for (std::size_t i = 0; i < lit.size(); ++i)
    seen.push_back(
        {find_board(picture_of(bent_camera(), test_board, lit[i], 0.7, 2, 50 + i), test_board),
         find_stripe_pixels(stripe_picture(lit[i], board_light, i), sensor)});
  const auto found = calibrate_light_plane(test_board, camera.camera, camera.covariance, seen);
  EXPECT_LT(found.misfit, 2);
  Eigen::Matrix3d covariance;
  const Eigen::Vector3d error = normalised(found, covariance);
  RecordProperty("chi2", std::to_string(error.dot(covariance.ldlt().solve(error))));
  RecordProperty("misfit", std::to_string(found.misfit));
  EXPECT_LT(error.dot(covariance.ldlt().solve(error)), 16.3);  // 999 of 1000

  const Pose wall = held_board(bent_camera(), test_board, {395, 305}, 0.3, 0.4, 0.3);
  StripeImages frames{{.camera = camera.camera,
                       .plane_normal = found.normal,
                       .plane_offset_m = found.offset_m,
                       .sensor = sensor},
                      {stripe_picture(
                          wall, [](const Eigen::Vector2d&) { return 0.8; }, 99)},
                      {Pose::Identity()}};
  const Scan points = acquire_laser_line(frames);
  ASSERT_GT(points.cloud.size(), 400u);
  const Eigen::Vector3d normal = wall.linear().col(2);
  double mean_m = 0, squares = 0;
  for (const Eigen::Vector3d& point : points.cloud.points) {
    const double off_m = normal.dot(point - wall.translation());
    mean_m += off_m / static_cast<double>(points.cloud.size());
    squares += off_m * off_m / static_cast<double>(points.cloud.size());
  }
  RecordProperty("mean_um", std::to_string(1e6 * mean_m));
  RecordProperty("rms_um", std::to_string(1e6 * std::sqrt(squares)));
  // What is off is off for the whole stripe: as much as the calibration's depth at its middle may
  // be. Four sigma; the stripe's own noise is a tenth of that.
  const double sigma_m = depth_sigma_m(unknowns_of(camera.camera, found), found.covariance,
                                       {*stripe_column(wall, 305), 305});
  RecordProperty("sigma_um", std::to_string(1e6 * sigma_m));
  EXPECT_LT(std::abs(mean_m), 4 * sigma_m);
  EXPECT_LT(sigma_m, 2e-4);
}

TEST(CalibrateLightPlane, RefusesStripesOnOneLine) {
  RandomStream random(1, 0, 0);
  const Pose pose = boards_in_light()[1];
  const std::vector<StripeOnBoard> seen = {seen_stripe(pose, 0.05, 0.1, random),
                                           seen_stripe(pose, 0.05, 0.1, random)};
  try {
    calibrate_light_plane(test_board, bent_camera(), CameraCovariance::Zero(), seen);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::computation);
    EXPECT_TRUE(std::string(error.what()).starts_with("light plane: all stripes lie on one line"))
        << error.what();
  }
}

TEST(CalibrateLightPlane, WantsTwoPicturesWithTheStripe) {
  RandomStream random(1, 0, 0);
  std::vector<StripeOnBoard> seen;
  for (const Pose& pose : boards_in_light()) seen.push_back(seen_stripe(pose, 0.05, 0.1, random));
  seen.resize(2);
  seen[1].stripe.resize(3);
  try {
    calibrate_light_plane(test_board, bent_camera(), CameraCovariance::Zero(), seen);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::input);
    EXPECT_EQ(std::string(error.what()),
              "light plane: 1 pictures show board and stripe, must be at least 2; one shows fewer "
              "than 20 rows with the stripe on the board");
  }
}

}  // namespace
}  // namespace scan
