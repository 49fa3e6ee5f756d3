// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/calibrate_light_plane.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "libscan/acquire/board_bundle.h"
#include "libscan/acquire/laser_line.h"
#include "libscan/core/error.h"
#include "tests/acquire/board_pictures.h"

namespace scan {
namespace {

using test::bent_camera;
using test::held_board;
using test::held_boards;
using test::picture_of;
using test::test_board;

// From a laser 0.12 m to the right of the camera to a place 0.3 m before it.
const Eigen::Vector3d true_normal = Eigen::Vector3d(0.3, 0.01, 0.12).normalized();
const double true_offset_m = true_normal.dot(Eigen::Vector3d(0, 0, 0.3));

const Sensor sensor{.gain_e_per_dn = 4, .read_noise_e = 10, .full_well_e = 16000, .bits = 12};

// Boards near the light plane, at three distances, tilted.
std::vector<Pose> boards_in_light() {
  std::vector<Pose> poses;
  for (int i = 0; i < 6; ++i) {
    const double z_m = 0.24 + 0.03 * (i % 4);
    const double x_m = (true_offset_m - true_normal.z() * z_m) / true_normal.x();
    const Camera camera = bent_camera();
    poses.push_back(
        held_board(camera, test_board, {395 + 900 * x_m / z_m, 305}, z_m, 0.3 + 0.05 * i, 1.0 * i));
  }
  return poses;
}

// Distance from the light plane of the place that a pixel sees on a plane normal . x = offset.
double off_plane_m(const Eigen::Vector2d& pixel, const Eigen::Vector3d& normal, double offset_m) {
  const Eigen::Vector3d ray = ray_through(bent_camera(), pixel).value();
  return true_normal.dot(ray * (offset_m / normal.dot(ray))) - true_offset_m;
}

// The column at which a row sees the stripe on a board, by bisection; none outside the picture.
std::optional<double> stripe_column(const Pose& pose, int row) {
  const Eigen::Vector3d normal = pose.linear().col(2);
  const double offset_m = normal.dot(pose.translation());
  double low = 0, high = bent_camera().width_px - 1;
  const auto off = [&](double column) {
    return off_plane_m({column, static_cast<double>(row)}, normal, offset_m);
  };
  if (off(low) * off(high) > 0) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (off(low) * off(middle) > 0 ? low : high) = middle;
  }
  return low;
}

StripeOnBoard seen_stripe(const Pose& pose, double corner_sigma_px, double stripe_sigma_px,
                          RandomStream& random) {
  StripeOnBoard seen{test::sighting(bent_camera(), test_board, pose, corner_sigma_px, random), {}};
  for (int row = 0; row < bent_camera().height_px; row += 4)
    if (const auto column = stripe_column(pose, row))
      seen.stripe.push_back(
          {{*column + stripe_sigma_px * random.normal(), row}, stripe_sigma_px, 1.5});
  return seen;
}

// The laser's Gaussian light, 0.2 mm of sigma, on a plane of the given brightness.
template <class Reflectance>
Image<std::uint16_t> stripe_picture(const Pose& pose, Reflectance&& reflectance,
                                    std::uint64_t seed) {
  const Camera camera = bent_camera();
  const Eigen::Vector3d normal = pose.linear().col(2);
  const double offset_m = normal.dot(pose.translation());
  const Pose board_from_camera = pose.inverse();
  Image<std::uint16_t> picture(camera.width_px, camera.height_px);
  RandomStream random(seed, 2, 0);
  for (int row = 0; row < camera.height_px; ++row)
    for (int column = 0; column < camera.width_px; ++column) {
      const Eigen::Vector2d pixel(column, row);
      const double off = off_plane_m(pixel, normal, offset_m) / 2e-4;
      double expected_e = 0;
      if (std::abs(off) < 8) {
        const Eigen::Vector2d at = test::on_board(camera, board_from_camera, pixel);
        expected_e = 12000 * reflectance(at) * std::exp(-off * off / 2);
      }
      const double noise_e = sensor.read_noise_e * random.normal();
      const double electrons = static_cast<double>(random.poisson(expected_e)) + noise_e;
      picture(column, row) =
          static_cast<std::uint16_t>(std::clamp(std::round(electrons / 4), 0.0, 4000.0));
    }
  return picture;
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
