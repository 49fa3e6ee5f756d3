// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/residual.h"

#include "libscan/core/pose.h"

namespace scan {

Eigen::Vector3d PointToPoint::value(const PointPair& pair) { return pair.moved - pair.target; }

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

}  // namespace scan
