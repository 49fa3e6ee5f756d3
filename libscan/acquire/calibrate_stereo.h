// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Two cameras and how they stand to each other, from pairs of pictures of a board.
#pragma once

#include <span>
#include <vector>

#include "libscan/acquire/calibrate_camera.h"
#include "libscan/acquire/rectify.h"

namespace scan {

// One place of the board, seen by both cameras.
struct BoardPair {
  BoardSighting left;
  BoardSighting right;
};

// Order of rows: those of CameraCovariance for left and right, the twist of right_from_left
// (rotation rad, translation m).
using RigCovariance = Eigen::Matrix<double, 24, 24>;

struct RigCalibration {
  StereoRig rig;
  RigCovariance covariance = RigCovariance::Zero();
  double baseline_m = 0;
  double baseline_sigma_m = 0;  // beside it, as for all lengths, the share that squares are off
  double rms_px = 0;
  double sigma_px = 0;         // of one coordinate of a corner
  double epipolar_rms_px = 0;  // of right corners from the lines on which the left ones put them
  double nearest_m = 0;        // depths of the boards' corners before the left camera
  double farthest_m = 0;
  double coverage_left = 0;  // shares of the pictures that boards covered
  double coverage_right = 0;
  std::vector<PictureUse> pairs;  // as given
};

// All unknowns at once: both cameras, their pose and the boards'. scan::Error: usage for a board
// that looks the same when turned by half, otherwise as calibrate_camera.
RigCalibration calibrate_stereo(const Board& board, std::span<const BoardPair> pairs,
                                const CalibrateOptions& options = {});

}  // namespace scan
