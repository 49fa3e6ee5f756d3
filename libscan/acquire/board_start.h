// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// First guesses for the bundle adjustment of board pictures.
#pragma once

#include <span>

#include "libscan/acquire/board.h"
#include "libscan/acquire/board_bundle.h"

namespace scan::calibrating {

// Focal length from the pictures' homographies, centre in the middle, no distortion (Zhang, PAMI
// 22, 2000, by OpenCV). Where they tell no sensible focal length, the width of the picture.
Camera first_camera(const Board& board, std::span<const BoardSighting> sightings);

// camera_from_board, by the infinitesimal plane-based method (Collins and Bartoli, IJCV 109, 2014,
// by OpenCV). scan::Error (computation) if the corners allow none.
Pose first_pose(const Camera& camera, const Board& board,
                std::span<const Eigen::Vector2d> corners_px);

// A camera and the poses of its boards from nothing but its pictures, which all show the board.
BundleFit fit_camera(const Board& board, std::span<const BoardSighting> sightings,
                     int distortion_terms);

}  // namespace scan::calibrating
