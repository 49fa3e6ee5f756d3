// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A plane through points that lie on boards whose poses are uncertain.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "libscan/core/pose.h"

namespace scan::calibrating {

// Where a viewing ray meets the board, camera frame.
struct StripePoint {
  Eigen::Vector3d place_m;
  Eigen::Vector3d shift_m;  // when the stripe's column is off by one sigma
};

// The points of one place of the board: they move along their rays when the board's pose is off.
struct BoardStripe {
  std::vector<StripePoint> points;
  Eigen::Vector3d board_normal;
  Matrix6 pose_covariance;  // twist from the left, camera frame
};

// The plane normal . (x - centre) = offset_m; its unknowns: turns of the normal towards the two
// axes, and the offset.
struct StripePlane {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  Eigen::Matrix<double, 3, 2> axes;
  double offset_m = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // not yet times misfit^2
  double spread = 0;  // rms across the points' longest direction, as a share of that along it
  double rms_m = 0;
  double misfit = 0;
};

// Gauss and Newton; each board's six pose errors are unknowns with their covariance as prior, which
// is generalised least squares. `spread` alone is meant if it is below `min_spread`.
StripePlane fit_stripe_plane(std::span<const BoardStripe> stripes, double min_spread);

}  // namespace scan::calibrating
