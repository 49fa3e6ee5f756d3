// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A laser's light plane from its stripe on a board that stands in two or more places.
#pragma once

#include <span>
#include <vector>

#include "libscan/acquire/calibrate_camera.h"
#include "libscan/acquire/laser_line.h"

namespace scan {

// The stripe's place in one image row.
struct StripePixel {
  Eigen::Vector2d pixel;
  double sigma_px = 0;  // of the column
  double width_px = 0;  // 1 sigma of the stripe itself
};

// The rows of a picture in which acquire_laser_line would see the stripe.
std::vector<StripePixel> find_stripe_pixels(const Image<std::uint16_t>& image, const Sensor& sensor,
                                            const LaserLineOptions& options = {});

// One place of the board: its corners in one picture, the stripe in another or the same one.
struct StripeOnBoard {
  BoardSighting board;
  std::vector<StripePixel> stripe;
};

struct LightPlaneOptions {
  // Rms spread of the points across their longest direction, as a share of the spread along it:
  // below, all stripes are one line, and the plane may turn about it. A choice far above noise.
  double min_spread = 0.05;
};

// Order of rows: those of CameraCovariance, the normal's x, y, z and the offset.
using LaserCovariance = Eigen::Matrix<double, 13, 13>;

struct LightPlaneCalibration {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();     // unit, camera frame
  double offset_m = 0;                                   // normal . x = offset_m on the plane
  LaserCovariance covariance = LaserCovariance::Zero();  // of camera and plane together
  double rms_m = 0;                                      // distance of the points from the plane
  double misfit = 0;  // root of chi-square per degree of freedom: 1 where the sigmas are right
  std::size_t points = 0;
  std::vector<PictureUse> pictures;  // as given; rms_px of the board's corners
};

// Where the stripe's viewing rays meet the board, within its outer corners and farther than three
// stripe widths from the squares' edges, which shift a stripe; the plane by generalised least
// squares: what a board's pose is off moves all of its points together. The covariance holds the
// stripes' and the corners' noise (times misfit^2 where that is above 1) and what the camera's own
// covariance does to the plane. scan::Error: input if fewer than two pictures show board and
// stripe, computation if all stripes are one line.
LightPlaneCalibration calibrate_light_plane(const Board& board, const Camera& camera,
                                            const CameraCovariance& camera_covariance,
                                            std::span<const StripeOnBoard> pictures,
                                            const LightPlaneOptions& options = {});

}  // namespace scan
