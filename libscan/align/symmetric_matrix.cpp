// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/symmetric_matrix.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan {

namespace {

// The root of z^3 - 3 z = 2 c in [sqrt(3), 2], c in [0, 1]: the one that has no other near it. The
// parabola through its values at 0 and 1 with the slope 2 / 9 there is off by less than 0.005, and
// each of Newton's steps squares that.
double greatest_root(double c) {
  const double below = 1 - c;
  double z = 2 - below * (2.0 / 9 + (2 - std::numbers::sqrt3 - 2.0 / 9) * below);
  for (int step = 0; step < 3; ++step) z -= (z * (z * z - 3) - 2 * c) / (3 * (z * z - 1));
  return z;
}

}  // namespace

Eigen::Vector3d eigenvalues_of(const Eigen::Matrix3d& matrix) {
  const double mean = matrix.trace() / 3;
  const Eigen::Matrix3d off = matrix - mean * Eigen::Matrix3d::Identity();
  const double size = std::sqrt(off.squaredNorm() / 6);
  if (!(size > 0)) return Eigen::Vector3d::Constant(mean);
  // det(B - z) = 0 for B = off / size is z^3 - 3 z = det(B) = 2 c; -z solves it for -c.
  const double c = std::clamp(((1 / size) * off).determinant() / 2, -1.0, 1.0);
  const double single = std::copysign(greatest_root(std::abs(c)), c);
  // The others have the sum -z and the product z^2 - 3.
  const double half_gap = std::sqrt(std::max(0.0, 3 - 0.75 * single * single));
  const double low = c > 0 ? -single / 2 - half_gap : single;
  const double high = c > 0 ? single : -single / 2 + half_gap;
  return {mean + size * low, mean - size * (low + high), mean + size * high};
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
