// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A camera's calibration from pictures of a board.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "libscan/acquire/board.h"
#include "libscan/core/camera.h"
#include "libscan/core/pose.h"

namespace scan {

// Order of rows in covariances: fx, fy, cx, cy, k1, k2, p1, p2, k3.
using CameraCovariance = Eigen::Matrix<double, 9, 9>;

struct CalibrateOptions {
  int distortion_terms = 4;  // the first so many of k1, k2, p1, p2, k3; the others are zero
  // A picture whose rms is so many times the median's is left out: its corners are not the board's,
  // or the board was bent. For more than 50 corners chance moves an rms by a tenth.
  double max_rms_ratio = 3;
  // Largest standard deviation of focal length and centre, as a share of the focal length, and of a
  // baseline, as a share of it; above it the pictures do not determine the camera or the pair.
  // Useful calibrations reach 0.001.
  double max_relative_sigma = 0.05;
};

// Throws scan::Error (usage) naming the field that is out of its domain.
void check(const CalibrateOptions& options);

// What became of one picture.
struct PictureUse {
  std::string left_out;  // why; empty if it was used
  double rms_px = 0;     // distance of its corners from where the calibration puts them
};

struct CameraCalibration {
  Camera camera;
  CameraCovariance covariance = CameraCovariance::Zero();  // zero for terms that were not sought
  double rms_px = 0;                    // distance of a corner from where the calibration puts it
  double sigma_px = 0;                  // of one coordinate of a corner, from the residuals
  double coverage = 0;                  // share of the picture that boards covered
  double ray_sigma_px = 0;              // of the pixel that a ray meets: the largest in the picture
  std::vector<PictureUse> pictures;     // as given
  std::vector<Pose> camera_from_board;  // of those used, in order
};

// Least squares of the corners' distances over camera and board poses. scan::Error: input if no
// picture shows the board (naming what the pictures show), computation if the pictures leave focal
// length or centre open (naming the direction).
CameraCalibration calibrate_camera(const Board& board, std::span<const BoardSighting> sightings,
                                   const CalibrateOptions& options = {});

namespace calibrating {

// Those that show the board, in pictures of one size; the others are told of in `uses`. Throws
// scan::Error (input) if none is left.
std::vector<std::size_t> usable(const Board& board, std::span<const BoardSighting> sightings,
                                std::vector<PictureUse>& uses);

// Takes the pictures whose rms is above `ratio` times the median out of `used` and tells so in
// `uses`; false if there are none.
bool drop_far_off(std::span<const double> rms_px, double ratio, std::vector<std::size_t>& used,
                  std::vector<PictureUse>& uses);

// Throws scan::Error (computation) naming the direction of focal length and centre that is open.
void check_determined(const std::string& name, const Camera& camera,
                      const CameraCovariance& covariance, double max_relative_sigma);

// Share of the picture within the outlines of the boards.
double coverage(const Board& board, std::span<const BoardSighting> sightings,
                std::span<const std::size_t> used);

double largest_ray_sigma_px(const Camera& camera, const CameraCovariance& covariance);

}  // namespace calibrating
}  // namespace scan
