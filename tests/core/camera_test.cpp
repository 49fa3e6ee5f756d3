// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The camera against its own inverse, against OpenCV, and at the border of its distortion.
#include "libscan/core/camera.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "libscan/core/error.h"

namespace scan {
namespace {

Camera strong_barrel() {
  return {.width_px = 640, .height_px = 480, .fx_px = 400, .fy_px = 410, .cx_px = 315.5,
          .cy_px = 243.25, .k1 = -0.25, .k2 = 0.09, .p1 = 0.003, .p2 = -0.002, .k3 = -0.01};
}

Camera strong_pincushion() {
  Camera camera = strong_barrel();
  camera.k1 = 0.3;
  camera.k2 = 0.1;
  return camera;
}

// Header: the inverse is good to 1e-12 in normalised coordinates, times 400 px.
TEST(Camera, RayThroughInvertsProject) {
  for (const Camera& camera : {strong_barrel(), strong_pincushion(), Camera{640, 480, 400, 410}})
    for (int row = 0; row < camera.height_px; row += 13)
      for (int column = 0; column < camera.width_px; column += 13) {
        const Eigen::Vector2d pixel(column + 0.3, row - 0.2);
        const auto ray = ray_through(camera, pixel);
        ASSERT_TRUE(ray.has_value()) << pixel.transpose();
        EXPECT_EQ(ray->z(), 1);
        const auto back = project(camera, 2.5 * *ray);
        ASSERT_TRUE(back.has_value());
        EXPECT_LT((*back - pixel).norm(), 1e-9);
      }
}

// An independent program: OpenCV's distortion with the same five coefficients. Both round a
// polynomial of size 1 times 400 px: 1e-12 px.
TEST(Camera, ProjectsAsOpenCV) {
  const Camera c = strong_barrel();
  const cv::Matx33d intrinsics(c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
  const cv::Vec<double, 5> distortion(c.k1, c.k2, c.p1, c.p2, c.k3);
  std::vector<cv::Point3d> points;
  for (double x = -0.8; x <= 0.8; x += 0.1)
    for (double y = -0.6; y <= 0.6; y += 0.1) points.emplace_back(2 * x, 2 * y, 2);
  std::vector<cv::Point2d> expected;
  cv::projectPoints(points, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), intrinsics, distortion,
                    expected);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = project(c, {points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->x(), expected[i].x, 1e-11);
    EXPECT_NEAR(pixel->y(), expected[i].y, 1e-11);
  }
}

TEST(Camera, SeesNothingBehindItself) {
  EXPECT_FALSE(project(strong_barrel(), {0, 0, -1}).has_value());
  EXPECT_FALSE(project(strong_barrel(), {1, 0, 0}).has_value());
  EXPECT_FALSE(project(strong_barrel(), {0, 0, std::nan("")}).has_value());
}

// With k1 alone r (1 + k1 r^2) folds at r = 1 / sqrt(-3 k1), where it is 2/3 of that: no ray leads
// to a pixel beyond.
TEST(Camera, HasNoRayBeyondTheFold) {
  const Camera camera{.width_px = 640, .height_px = 480, .fx_px = 100, .fy_px = 100, .cx_px = 0,
                      .cy_px = 0, .k1 = -0.3};
  const double fold = 1 / std::sqrt(0.9), limit_px = 100 * 2.0 / 3 * fold;
  EXPECT_TRUE(ray_through(camera, {0.99 * limit_px, 0}).has_value());
  EXPECT_FALSE(ray_through(camera, {1.01 * limit_px, 0}).has_value());
  // the inverse is the near branch
  EXPECT_LT(ray_through(camera, {0.99 * limit_px, 0})->x(), fold);
}

TEST(Camera, CheckNamesTheField) {
  Camera camera = strong_barrel();
  EXPECT_NO_THROW(check(camera));
  camera.fy_px = 0;
  try {
    check(camera);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("fy_px"), std::string::npos);
  }
  camera = strong_barrel();
  camera.p2 = std::nan("");
  EXPECT_THROW(check(camera), Error);
}

}  // namespace
}  // namespace scan
