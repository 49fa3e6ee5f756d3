// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rigid motions in three dimensions: SE(3) with its exponential, logarithm and distances.
//
// A pose is written `a_from_b` and maps points `x_in_b` to `x_in_a = a_from_b * x_in_b`. Tangent
// vectors are ordered (rotation rad, translation m) and act from the left:
// perturbed = exp(twist) * pose.
#pragma once

#include <Eigen/Geometry>

namespace scan {

using Pose = Eigen::Isometry3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// The matrix of v -> w x v.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w);

// Exponential map of a twist (rotation rad, translation m); exact to rounding for any angle.
Pose exp(const Vector6& twist);

// Inverse of exp for rotation angles in [0, pi]; at pi either of the two axes is right.
Vector6 log(const Pose& pose);

// Angle of the rotation in [0, pi], radians; accurate near 0 and near pi.
double rotation_angle_rad(const Eigen::Matrix3d& rotation);

// Angle between the rotations of two poses, radians.
double rotation_distance_rad(const Pose& a, const Pose& b);

// Distance between the origins of two poses, metres.
double translation_distance_m(const Pose& a, const Pose& b);

// The proper rotation (det = +1) nearest to `matrix` in the Frobenius norm. `matrix` must be
// finite; of a rank-deficient one some nearest rotation is returned.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

// Pose with rotation `rotation` (proper) and origin `translation` in metres.
Pose make_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

// Pose of a device at `eye` (metres, world) that looks along its +z at `target`, its +y as near to
// -up as can be (image rows grow downwards). `up` may be parallel to the view: then x is chosen.
Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up);

}  // namespace scan
