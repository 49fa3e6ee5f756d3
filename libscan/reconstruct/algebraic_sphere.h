// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Spheres and planes in one linear form, fitted to points with normals.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace scan {

// The zero set of constant + linear . x + square |x|^2, negative inside; a plane for square = 0.
class SphereSums;

struct AlgebraicSphere {
  double constant = 0;
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  double square = 0;

  Eigen::Vector3d gradient(const Eigen::Vector3d& x) const { return linear + 2 * square * x; }
  // 0 for a sphere without points; Pratt's norm.
  double gradient_on_sphere() const;
  // Of the polynomial, over the weighted points of the sums.
  double mean_value(const SphereSums& sums) const;
  // Signed distance, exact for the sphere and the plane alike (Guennebaud and Gross 2007, eq. 10).
  double distance(const Eigen::Vector3d& x) const;
};

// Sums over points with normals and weights, in coordinates near the points.
class SphereSums {
 public:
  void add(double weight, const Eigen::Vector3d& x, const Eigen::Vector3d& normal);
  double weight() const { return weight_; }
  // The sphere whose gradients fit the normals best, then whose values vanish in the mean
  // (Guennebaud, Germann and Gross 2008, eqs. 3 to 5). None without weight.
  std::optional<AlgebraicSphere> fit() const;
  // Length of the mean normal: 1 on a plane, 0 on both sides of a sheet or all round a closed
  // surface.
  double agreement() const { return weight_ > 0 ? n_.norm() / weight_ : 0; }

 private:
  friend struct AlgebraicSphere;
  double weight_ = 0, x_dot_n_ = 0, x_dot_x_ = 0;
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero(), n_ = Eigen::Vector3d::Zero();
};

}  // namespace scan
