// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/symmetric_matrix.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan {

Eigen::Vector3d eigenvalues_of(const Eigen::Matrix3d& matrix) {
  const double mean = matrix.trace() / 3;
  const Eigen::Matrix3d off = matrix - mean * Eigen::Matrix3d::Identity();
  const double size = std::sqrt(off.squaredNorm() / 6);
  if (!(size > 0)) return Eigen::Vector3d::Constant(mean);
  // det(B - z) = 0 for B = off / size has the roots z = 2 cos(angle), 3 angle = acos(det(B) / 2).
  const double cosine = std::clamp((off / size).determinant() / 2, -1.0, 1.0);
  const double angle = std::acos(cosine) / 3;
  const double high = mean + 2 * size * std::cos(angle);
  const double low = mean + 2 * size * std::cos(angle + 2 * std::numbers::pi / 3);
  return {low, 3 * mean - low - high, high};
}

Eigen::Vector3d eigenvector_of(const Eigen::Matrix3d& matrix, double eigenvalue) {
  const Eigen::Matrix3d rest = matrix - eigenvalue * Eigen::Matrix3d::Identity();
  // Orthogonal to all columns: the best conditioned product of two of them.
  Eigen::Vector3d best = rest.col(0).cross(rest.col(1));
  double best2 = best.squaredNorm();
  for (const auto& [i, j] : {std::pair(0, 2), std::pair(1, 2)}) {
    const Eigen::Vector3d product = rest.col(i).cross(rest.col(j));
    const double product2 = product.squaredNorm();
    if (product2 > best2) best = product, best2 = product2;
  }
  if (best2 > 0) return best / std::sqrt(best2);
  int longest = 0;  // at most one dimension is fixed
  rest.colwise().squaredNorm().maxCoeff(&longest);
  return rest.col(longest).isZero(0) ? Eigen::Vector3d::UnitX()
                                     : Eigen::Vector3d(rest.col(longest).unitOrthogonal());
}

}  // namespace scan
