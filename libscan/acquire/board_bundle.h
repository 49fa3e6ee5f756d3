// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Bundle adjustment over pictures of a board: cameras, the pose between two of them, and where the
// board stood, by least squares of the corners' distances in the pictures.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "libscan/core/camera.h"
#include "libscan/core/pose.h"

namespace scan::calibrating {

// Of a corner's coordinates. No corner finder is better: residuals below it are a simulation's.
inline constexpr double least_sigma_px = 0.01;

// A camera's unknowns in order: fx, fy, cx, cy, k1, k2, p1, p2, k3.
inline constexpr int camera_unknowns = 9;
using CameraVector = Eigen::Matrix<double, camera_unknowns, 1>;
CameraVector unknowns_of(const Camera& camera);
Camera with_unknowns(Camera camera, const CameraVector& unknowns);

// Pixel of a point in the camera frame with its derivatives. Points behind the camera are mapped as
// the formula does: a step that leads there is refused by its cost.
struct Projection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point;
  Eigen::Matrix<double, 2, camera_unknowns> by_camera;
};
Projection project_with_derivatives(const Camera& camera, const Eigen::Vector3d& x_in_camera);

struct BoardPicture {
  std::vector<std::vector<Eigen::Vector2d>> corners_px;  // one list for each camera
  Pose first_from_board = Pose::Identity();              // frame of the first camera
};

// What is known and, as first guess, what is sought.
struct Bundle {
  std::vector<Eigen::Vector3d> board_m;
  std::vector<Camera> cameras;                // one or two
  Pose second_from_first = Pose::Identity();  // if there are two
  std::vector<BoardPicture> pictures;
  int distortion_terms = 4;    // the first so many of k1, k2, p1, p2, k3 are sought, others held
  bool fixed_cameras = false;  // cameras and second_from_first are held
};

struct BundleFit {
  Bundle bundle;
  // Inverse normal matrix: times the square of a corner's sigma it is the covariance. Rows: the
  // unknowns of each camera, then the twist of second_from_first (rotation rad, translation m);
  // zero for what is held. What the data leave open has huge entries.
  Eigen::MatrixXd cofactor;
  std::vector<Matrix6> pose_cofactors;  // of first_from_board, cameras known
  std::vector<double> picture_rms_px;   // root mean square distance of a corner
  double rms_px = 0;
  double sigma_px = 0;  // of one coordinate: root of the squares' sum by the degrees of freedom
  int iterations = 0;
  bool converged = false;
};

// Levenberg and Marquardt, the pictures' poses eliminated (Schur complement). Needs more
// coordinates than unknowns; scan::Error (computation) otherwise.
BundleFit adjust(const Bundle& guess);

}  // namespace scan::calibrating
