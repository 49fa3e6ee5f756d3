// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/residual.h"

#include "libscan/core/pose.h"

namespace scan {

Eigen::Vector3d PointToPoint::value(const PointPair& pair) {
  return pair.moved - pair.target;
}

Eigen::Matrix<double, 3, 6> PointToPoint::jacobian(const PointPair& pair,
                                                   const Eigen::Vector3d& centre) {
  Eigen::Matrix<double, 3, 6> j;  // d(w x a + t) = -[a]x w + t
  j << -cross_matrix(pair.moved - centre), Eigen::Matrix3d::Identity();
  return j;
}

double PointToPlane::value(const PointPair& pair) {
  return pair.normal.dot(pair.moved - pair.target);
}

Eigen::Matrix<double, 1, 6> PointToPlane::jacobian(const PointPair& pair,
                                                   const Eigen::Vector3d& centre) {
  Eigen::Matrix<double, 1, 6> j;  // n . (w x a + t) = (a x n) . w + n . t
  j << (pair.moved - centre).cross(pair.normal).transpose(), pair.normal.transpose();
  return j;
}

namespace {

Eigen::Vector3d on_the_same_side(const PointPair& pair) {
  return pair.moved_normal.dot(pair.normal) < 0 ? Eigen::Vector3d(-pair.moved_normal)
                                                : pair.moved_normal;
}

}  // namespace

double Symmetric::value(const PointPair& pair) {
  return 0.5 * (pair.normal + on_the_same_side(pair)).dot(pair.moved - pair.target);
}

// The motion turns m as well: d r = (w x a + t) . (n + m) / 2 + (w x m) . (p - q) / 2, and
// a x (n + m) + m x (p - q) = a x n + (q - c) x m.
Eigen::Matrix<double, 1, 6> Symmetric::jacobian(const PointPair& pair,
                                                const Eigen::Vector3d& centre) {
  const Eigen::Vector3d m = on_the_same_side(pair);
  Eigen::Matrix<double, 1, 6> j;
  j << 0.5 *
           ((pair.moved - centre).cross(pair.normal) + (pair.target - centre).cross(m)).transpose(),
      0.5 * (pair.normal + m).transpose();
  return j;
}

}  // namespace scan
