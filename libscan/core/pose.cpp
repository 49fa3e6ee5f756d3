// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/pose.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace scan {
namespace {

// Coefficients of the exponential's series in W = cross_matrix(w), angle t = |w|:
// R = I + a W + b W^2, V = I + b W + c W^2 (Murray, Li, Sastry 1994, eq. 2.14 and 2.36).
struct ExpCoefficients {
  double a, b, c;
};

ExpCoefficients exp_coefficients(double t) {
  if (t < 1e-2) {  // next terms are below 1e-17 relative
    const double t2 = t * t;
    return {1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42)),
            0.5 - t2 / 24 * (1 - t2 / 30 * (1 - t2 / 56)),
            1.0 / 6 - t2 / 120 * (1 - t2 / 42 * (1 - t2 / 72))};
  }
  const double half = std::sin(t / 2);
  return {std::sin(t) / t, 2 * half * half / (t * t), (t - std::sin(t)) / (t * t * t)};
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-8) return 2 / q.w() * q.vec();
  return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

Pose exp(const Vector6& twist) {
  const Eigen::Vector3d w = twist.head<3>();
  const Eigen::Matrix3d W = cross_matrix(w);
  const Eigen::Matrix3d W2 = W * W;
  const auto [a, b, c] = exp_coefficients(w.norm());
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  return make_pose(I + a * W + b * W2, (I + b * W + c * W2) * twist.tail<3>());
}

Vector6 log(const Pose& pose) {
  const Eigen::Vector3d w = rotation_vector(pose.linear());
  const Eigen::Matrix3d W = cross_matrix(w);
  const auto [a, b, c] = exp_coefficients(w.norm());
  const Eigen::Matrix3d V = Eigen::Matrix3d::Identity() + b * W + c * W * W;
  Vector6 twist;
  twist << w, V.inverse() * pose.translation();
  return twist;
}

double rotation_angle_rad(const Eigen::Matrix3d& rotation) {
  return rotation_vector(rotation).norm();
}

double rotation_distance_rad(const Pose& a, const Pose& b) {
  return rotation_angle_rad(a.linear().transpose() * b.linear());
}

double translation_distance_m(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm();
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1,
                        (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Pose make_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

Pose look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up) {
  const Eigen::Vector3d z = (target - eye).normalized();
  Eigen::Vector3d x = z.cross(up);
  if (x.norm() < 1e-9 * up.norm()) x = z.unitOrthogonal();
  x.normalize();
  Eigen::Matrix3d rotation;
  rotation << x, z.cross(x), z;
  return make_pose(rotation, eye);
}

}  // namespace scan
