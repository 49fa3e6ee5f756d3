// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/rectify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/shortest.h"

namespace scan {
namespace {

constexpr double least_cosine = 0.7;  // of 45 degrees

[[noreturn]] void refuse(const std::string& what) {
  throw Error(Trouble::input, "stereo rig: " + what);
}

// To a tenth of a millimetre.
std::string rounded(double metres) {
  return shortest(std::round(1e4 * metres) / 1e4);
}

void check(const StereoRig& rig, double nearest_m, double farthest_m) {
  check(rig.left);
  check(rig.right);
  if (rig.left.width_px != rig.right.width_px || rig.left.height_px != rig.right.height_px)
    refuse("left and right pictures must have one size");
  if (!(nearest_m > 0) || !(farthest_m > nearest_m))
    refuse("depths from " + shortest(nearest_m) + " m to " + shortest(farthest_m) +
           " m, must be positive and rising");
}

// Rows: right along the baseline, down, forwards.
Eigen::Matrix3d rectified_from_left(const StereoRig& rig) {
  const Eigen::Matrix3d left_from_right = rig.right_from_left.linear().transpose();
  const Eigen::Vector3d baseline = -left_from_right * rig.right_from_left.translation();
  const Eigen::Vector3d x = baseline.normalized();
  if (!(x.x() >= least_cosine))
    refuse("the right camera stands at " + rounded(baseline.x()) + " m to the right and " +
           rounded(std::hypot(baseline.y(), baseline.z())) + " m beside, must be to the right" +
           (baseline.x() < 0 ? "; are left and right exchanged?" : ""));
  if (!(left_from_right(2, 2) >= least_cosine)) refuse("the cameras look past each other");
  const Eigen::Vector3d forwards = Eigen::Vector3d::UnitZ() + left_from_right.col(2);
  Eigen::Matrix3d rows;
  rows.row(0) = x;
  rows.row(2) = (forwards - x * x.dot(forwards)).normalized();
  rows.row(1) = rows.row(2).cross(rows.row(0));
  return rows;
}

// Where the middle of a picture comes to lie, in units of the focal length.
Eigen::Vector2d middle_of(const Camera& camera, const Eigen::Matrix3d& rectified_from_camera) {
  const auto ray = ray_through(camera, {(camera.width_px - 1) / 2.0, (camera.height_px - 1) / 2.0});
  if (!ray) refuse("a camera's distortion has no inverse in the middle of its picture");
  return (rectified_from_camera * *ray).hnormalized();
}

void set_search_range(double nearest_m, double farthest_m, StereoCalibration& calibration) {
  const double scale_px_m = calibration.focal_px * calibration.baseline_m;
  const double least_px = std::floor(scale_px_m / farthest_m - calibration.doffs_px);
  const double most_px = std::ceil(scale_px_m / nearest_m - calibration.doffs_px);
  if (!(std::abs(least_px) <= calibration.width_px && most_px - least_px < calibration.width_px))
    refuse("depths from " + shortest(nearest_m) + " m to " + shortest(farthest_m) +
           " m are disparities from " + shortest(least_px) + " px to " + shortest(most_px) +
           " px, must be fewer than the picture's " + std::to_string(calibration.width_px) +
           " columns");
  calibration.min_disparity_px = static_cast<int>(least_px);
  calibration.disparities_px = static_cast<int>(most_px - least_px) + 1;
}

// Keys' kernel with a = -1/2: exact for parabolas.
std::array<double, 4> cubic_weights(double t) {
  return {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (-2.5 + 1.5 * t),
          t * (0.5 + t * (2 - 1.5 * t)), t * t * (-0.5 + 0.5 * t)};
}

std::uint8_t sample(const Image<std::uint8_t>& image, const Eigen::Vector2d& pixel) {
  const int column = static_cast<int>(std::floor(pixel.x()));
  const int row = static_cast<int>(std::floor(pixel.y()));
  const auto across = cubic_weights(pixel.x() - column), down = cubic_weights(pixel.y() - row);
  double sum = 0;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      sum += down[static_cast<std::size_t>(j)] * across[static_cast<std::size_t>(i)] *
             image(std::clamp(column - 1 + i, 0, image.width - 1),
                   std::clamp(row - 1 + j, 0, image.height - 1));
  return static_cast<std::uint8_t>(std::clamp(std::round(sum), 0.0, 255.0));
}

Image<std::uint8_t> resampled(const Image<std::uint8_t>& image, const Camera& camera,
                              const Eigen::Matrix3d& camera_from_rectified, double focal_px,
                              const Eigen::Vector2d& centre_px) {
  Image<std::uint8_t> turned(image.width, image.height);
  parallel_for(turned.pixels.size(), [&](std::size_t i) {
    const auto width = static_cast<std::size_t>(image.width);
    const std::size_t row = i / width, column = i % width;
    const Eigen::Vector2d pixel(column, row);
    const Eigen::Vector2d flat = (pixel - centre_px) / focal_px;
    const auto seen = project(camera, camera_from_rectified * flat.homogeneous());
    if (seen && seen->x() >= 0 && seen->y() >= 0 && seen->x() <= image.width - 1 &&
        seen->y() <= image.height - 1)
      turned.pixels[i] = sample(image, *seen);
  });
  return turned;
}

}  // namespace

Rectification rectify(const StereoRig& rig, double nearest_m, double farthest_m) {
  check(rig, nearest_m, farthest_m);
  Rectification result{.rig = rig};
  result.rectified_from_left = rectified_from_left(rig);
  result.rectified_from_right =
      result.rectified_from_left * rig.right_from_left.linear().transpose();
  StereoCalibration& calibration = result.calibration;
  calibration.width_px = rig.left.width_px;
  calibration.height_px = rig.left.height_px;
  calibration.focal_px = (rig.left.fx_px + rig.left.fy_px + rig.right.fx_px + rig.right.fy_px) / 4;
  calibration.baseline_m = rig.right_from_left.translation().norm();
  const Eigen::Vector2d left = middle_of(rig.left, result.rectified_from_left);
  const Eigen::Vector2d right = middle_of(rig.right, result.rectified_from_right);
  const double focal_px = calibration.focal_px;
  calibration.cx_px = (calibration.width_px - 1) / 2.0 - focal_px * left.x();
  calibration.cy_px = (calibration.height_px - 1) / 2.0 - focal_px * (left.y() + right.y()) / 2;
  calibration.doffs_px = focal_px * (left.x() - right.x());
  set_search_range(nearest_m, farthest_m, calibration);
  return result;
}

ImagePair rectify(const Rectification& rectification, const Image<std::uint8_t>& left,
                  const Image<std::uint8_t>& right) {
  const StereoCalibration& c = rectification.calibration;
  for (const auto* image : {&left, &right})
    if (image->width != c.width_px || image->height != c.height_px)
      refuse("a picture is " + std::to_string(image->width) + " x " +
             std::to_string(image->height) + " px, the cameras' are " + std::to_string(c.width_px) +
             " x " + std::to_string(c.height_px));
  return {c,
          resampled(left, rectification.rig.left, rectification.rectified_from_left.transpose(),
                    c.focal_px, {c.cx_px, c.cy_px}),
          resampled(right, rectification.rig.right, rectification.rectified_from_right.transpose(),
                    c.focal_px, {c.cx_px + c.doffs_px, c.cy_px})};
}

}  // namespace scan
