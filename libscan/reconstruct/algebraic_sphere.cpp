// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/algebraic_sphere.h"

#include <algorithm>
#include <cmath>

namespace scan {

double AlgebraicSphere::gradient_on_sphere() const {
  return std::sqrt(std::max(0.0, linear.squaredNorm() - 4 * constant * square));
}

double AlgebraicSphere::distance(const Eigen::Vector3d& x) const {
  const double value = constant + linear.dot(x) + square * x.squaredNorm();
  return 2 * value / (gradient(x).norm() + gradient_on_sphere());
}

double AlgebraicSphere::mean_value(const SphereSums& sums) const {
  return constant + (linear.dot(sums.x_) + square * sums.x_dot_x_) / sums.weight_;
}

void SphereSums::add(double weight, const Eigen::Vector3d& x, const Eigen::Vector3d& normal) {
  weight_ += weight;
  x_dot_n_ += weight * x.dot(normal);
  x_dot_x_ += weight * x.squaredNorm();
  x_ += weight * x;
  n_ += weight * normal;
}

std::optional<AlgebraicSphere> SphereSums::fit() const {
  if (!(weight_ > 0)) return std::nullopt;
  AlgebraicSphere sphere;
  const double spread = x_dot_x_ - x_.squaredNorm() / weight_;
  // Below that one point has all the weight, and rounding would bend the plane through it.
  if (spread > 1e-6 * x_dot_x_) sphere.square = (x_dot_n_ - x_.dot(n_) / weight_) / (2 * spread);
  sphere.linear = (n_ - 2 * sphere.square * x_) / weight_;
  sphere.constant = -(sphere.linear.dot(x_) + sphere.square * x_dot_x_) / weight_;
  return sphere;
}

}  // namespace scan
