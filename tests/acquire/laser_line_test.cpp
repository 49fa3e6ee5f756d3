// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/laser_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "libscan/acquire/reason.h"
#include "libscan/core/error.h"
#include "tests/acquire/readings.h"

namespace scan {
namespace {

// Camera at the origin, laser at x = 0.1 m, its plane turned by 30 degrees towards the axis.
LaserLineCalibration device(double k1 = 0) {
  LaserLineCalibration calibration;
  calibration.camera = {.width_px = 240,
                        .height_px = 60,
                        .fx_px = 400,
                        .fy_px = 400,
                        .cx_px = 119.5,
                        .cy_px = 29.5,
                        .k1 = k1};
  const double angle = M_PI / 6;
  calibration.plane_normal = {std::cos(angle), 0, std::sin(angle)};
  calibration.plane_offset_m = 0.1 * std::cos(angle);
  calibration.sensor.bits = 16;
  return calibration;
}

// Implicit surface in the camera frame, positive on the camera's side.
using Surface = std::function<double(const Eigen::Vector3d&)>;

Surface plane(const Eigen::Vector3d& normal, double offset_m) {
  return [=](const Eigen::Vector3d& x) { return offset_m - normal.dot(x); };
}
Surface sphere(const Eigen::Vector3d& centre, double radius_m) {
  return [=](const Eigen::Vector3d& x) { return (x - centre).norm() - radius_m; };
}

Eigen::Vector3d on_light_plane(const LaserLineCalibration& c, double column, int row) {
  const Eigen::Vector3d ray = *ray_through(c.camera, {column, static_cast<double>(row)});
  return c.plane_offset_m / c.plane_normal.dot(ray) * ray;
}

// Where in a row the light plane meets the surface, by bisection between two columns.
double stripe_column(const LaserLineCalibration& c, const Surface& surface, int row) {
  double low = 20, high = 220;
  const bool low_in_front = surface(on_light_plane(c, low, row)) > 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    ((surface(on_light_plane(c, middle, row)) > 0) == low_in_front ? low : high) = middle;
  }
  return low;
}

struct Rendered {
  StripeImages frames;
  std::vector<Eigen::Vector3d> truth;  // per ray, camera frame
};

Rendered render(const LaserLineCalibration& c, const Surface& surface, double sigma_px,
                double amplitude_e, int steps, bool noise) {
  Rendered result;
  result.frames.calibration = c;
  for (int step = 0; step < steps; ++step) {
    Image<std::uint16_t> image(c.camera.width_px, c.camera.height_px);
    for (int row = 0; row < image.height; ++row) {
      RandomStream random(11, step, row);
      const double centre = stripe_column(c, surface, row);
      result.truth.push_back(on_light_plane(c, centre, row));
      for (int column = 0; column < image.width; ++column) {
        const double expected = 10 + amplitude_e * test::bell(column - centre, sigma_px);
        image(column, row) =
            noise ? test::noisy(c.sensor, expected, random) : test::digitise(c.sensor, expected);
      }
    }
    result.frames.images.push_back(image);
    result.frames.scanner_from_camera.push_back(
        make_pose(Eigen::AngleAxisd(0.1 * step, Eigen::Vector3d::UnitY()).toRotationMatrix(),
                  {0.01 * step, 0, 0}));
  }
  return result;
}

std::size_t total(const Scan& scan) {
  return std::accumulate(scan.misses.begin(), scan.misses.end(), scan.cloud.size(),
                         [](std::size_t sum, const auto& miss) { return sum + miss.second; });
}

// Noise-free readings leave their rounding: the peak errs by at most 3 s / A px (stripe_peak_test),
// and a column moves the point by at most 2 Z / (f sin(angle)) along the ray: with Z <= 0.25 m, s =
// 2 px, A = 20,000 e that is 0.75 um.
TEST(LaserLine, RecoversPlanesAndSpheresToTheRounding) {
  for (const double k1 : {0.0, -0.15})
    for (const Surface& surface : {plane({0.1, 0.2, 0.97}, 0.16), sphere({0, 0, 0.35}, 0.18)}) {
      const Rendered scene = render(device(k1), surface, 2, 20'000, 2, false);
      const Scan scan = acquire_laser_line(scene.frames);
      ASSERT_EQ(scan.cloud.size(), scene.truth.size());
      for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
        const Pose& pose = scene.frames.scanner_from_camera[scan.ray[i] / 60];
        EXPECT_LT((scan.cloud.points[i] - pose * scene.truth[scan.ray[i]]).norm(), 0.75e-6);
      }
    }
}

// The reported covariance has rank one; its part along the ray is sigma_m. The error's part along
// the direction of the covariance, over its length, is chi-square of one degree of freedom. The
// background's estimate and the fitted width add up to 5 %.
TEST(LaserLine, ReportsItsScatter) {
  for (const double k1 : {0.0, -0.15}) {
    const Rendered scene = render(device(k1), plane({0.1, 0.2, 0.97}, 0.16), 1.5, 500, 20, true);
    const Scan scan = acquire_laser_line(scene.frames);
    ASSERT_EQ(scan.cloud.size(), scene.truth.size());
    double along_ray = 0, whole = 0;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      const Pose& pose = scene.frames.scanner_from_camera[scan.ray[i] / 60];
      const Eigen::Vector3d truth = scene.truth[scan.ray[i]];
      const Eigen::Vector3d error = scan.cloud.points[i] - pose * truth;
      const Eigen::Matrix3d& covariance = scan.cloud.covariances[i];
      const Eigen::Vector3d ray = (pose.linear() * truth).normalized();
      EXPECT_NEAR(std::sqrt(ray.dot(covariance * ray)), scan.cloud.sigma_m[i],
                  1e-3 * scan.cloud.sigma_m[i]);  // the ray to the found point is another by 1e-4
      along_ray += std::pow(error.dot(ray) / scan.cloud.sigma_m[i], 2);
      whole += error.squaredNorm() / covariance.trace();
    }
    const auto count = static_cast<double>(scan.cloud.size());
    EXPECT_NEAR(along_ray / count, 1, test::chi_square_margin(count, 0.05));
    EXPECT_NEAR(whole / count, 1, test::chi_square_margin(count, 0.05));
  }
}

// A plate at z = 0.2 m that ends at x = 0, passed in steps of two thirds of a beam sigma of 0.5 mm:
// where the plane of light goes past it, its tail still lights the edge, whose place is not on that
// plane. What is left of such stripes is cut no nearer than 0.8 widths from its centre, where the
// fit is 0.5 widths off, 3.3 of the 0.15 that are stated, and 1.5 more for noise of a tenth of it.
TEST(LaserLine, TakesNoEdgeForThePlaneOfLight) {
  LaserLineCalibration c = device();
  StripeImages frames{.calibration = c};
  for (int step = 0; step < 60; ++step) {
    const double head_m = -0.002 + step * 0.5e-3 / 1.5;  // over the edge at 0.0155
    Image<std::uint16_t> image(c.camera.width_px, c.camera.height_px);
    for (int row = 0; row < image.height; ++row) {
      RandomStream random(12, step, row);
      for (int column = 0; column < image.width; ++column) {
        double expected_e = 10;
        for (int part = 0; part < 8; ++part) {
          const double u = column + (part + 0.5) / 8 - 0.5;
          const Eigen::Vector3d x = 0.2 * *ray_through(c.camera, {u, double(row)});
          const double off = (c.plane_normal.dot(x) - c.plane_offset_m) / 0.5e-3;
          if (x.x() + head_m < 0) expected_e += 5000.0 / 8 * std::exp(-off * off / 2);
        }
        image(column, row) = test::noisy(c.sensor, expected_e, random);
      }
    }
    frames.images.push_back(image);
    frames.scanner_from_camera.push_back(
        make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(head_m, 0, 0)));
  }
  const Scan scan = acquire_laser_line(frames, {.max_shape_error = 0.03});
  EXPECT_GT(scan.cloud.size(), 1500u);
  EXPECT_GT(scan.misses.at(std::string(reason::inconsistent)), 60u);
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    EXPECT_LT(std::abs(scan.cloud.points[i].z() - 0.2),
              4.8 * std::sqrt(scan.cloud.covariances[i](2, 2)))
        << scan.ray[i] / 60 << " " << scan.ray[i] % 60;
}

TEST(LaserLine, EveryRowIsAPointOrAMiss) {
  Rendered scene = render(device(), plane({0, 0, 1}, 0.17), 2, 2000, 3, false);
  for (int row = 0; row < 10; ++row)  // dark
    for (int column = 0; column < 240; ++column) scene.frames.images[0](column, row) = 10;
  for (int row = 10; row < 15; ++row)  // clipped
    for (int column = 0; column < 240; ++column)
      if (scene.frames.images[0](column, row) > 1000) scene.frames.images[0](column, row) = 65535;
  for (int row = 15; row < 22; ++row)  // a second, equal stripe
    for (int column = 0; column < 60; ++column)
      scene.frames.images[0](column, row) +=
          static_cast<std::uint16_t>(2000 * test::bell(column - 30, 2));
  const Scan scan = acquire_laser_line(scene.frames);
  EXPECT_EQ(total(scan), 180u);
  EXPECT_EQ(scan.misses.at(std::string(reason::no_signal)), 10u);
  EXPECT_EQ(scan.misses.at(std::string(reason::saturated)), 5u);
  EXPECT_EQ(scan.misses.at(std::string(reason::ambiguous)), 7u);
  EXPECT_EQ(scan.grid.rows, 3u);
  EXPECT_EQ(scan.grid.columns, 60u);
}

TEST(LaserLine, NothingLiesOutsideTheRange) {
  Rendered scene = render(device(), plane({0, 0, 1}, 0.17), 2, 2000, 1, false);
  scene.frames.calibration.max_range_m = 0.16;
  EXPECT_EQ(acquire_laser_line(scene.frames).misses.at(std::string(reason::out_of_range)), 60u);
  scene.frames.calibration.max_range_m = 1;
  scene.frames.calibration.min_range_m = 0.18;
  EXPECT_EQ(acquire_laser_line(scene.frames).misses.at(std::string(reason::out_of_range)), 60u);
}

// A light plane that holds the viewing rays themselves (through the camera's centre), or nearly so,
// or that a ray meets behind the camera, gives no depth: a reason, not infinity.
TEST(LaserLine, DepthIsUndeterminedWhereRayAndPlaneAreParallel) {
  Rendered scene = render(device(), plane({0, 0, 1}, 0.17), 2, 2000, 1, false);
  LaserLineCalibration& c = scene.frames.calibration;
  const double column = stripe_column(device(), plane({0, 0, 1}, 0.17), 0);
  const Eigen::Vector3d ray = *ray_through(c.camera, {column, 29.5});
  for (const double offset : {0.0, 0.1}) {
    c.plane_normal = ray.cross(Eigen::Vector3d::UnitY()).normalized();  // contains every row's ray
    c.plane_offset_m = offset;
    EXPECT_EQ(acquire_laser_line(scene.frames).misses.at(std::string(reason::undetermined)), 60u);
  }
  c = device();
  c.plane_offset_m = -c.plane_offset_m;
  EXPECT_EQ(acquire_laser_line(scene.frames).misses.at(std::string(reason::undetermined)), 60u);
}

TEST(LaserLine, RefusesBrokenFrames) {
  const Rendered scene = render(device(), plane({0, 0, 1}, 0.17), 2, 2000, 1, false);
  StripeImages frames = scene.frames;
  frames.scanner_from_camera.clear();
  EXPECT_THROW(acquire_laser_line(frames), Error);
  frames = scene.frames;
  frames.images[0] = Image<std::uint16_t>(3, 3);
  EXPECT_THROW(acquire_laser_line(frames), Error);
  frames = scene.frames;
  frames.calibration.plane_normal *= 2;
  EXPECT_THROW(acquire_laser_line(frames), Error);
  EXPECT_EQ(acquire_laser_line({.calibration = device(), .images = {}, .scanner_from_camera = {}})
                .cloud.size(),
            0u);
}

}  // namespace
}  // namespace scan
