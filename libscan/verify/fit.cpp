// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Orthogonal-distance fits of sphere and plane.
#include "libscan/verify/fit.h"

#include <Eigen/SVD>
#include <cmath>

#include "libscan/verify/fit_points.h"

namespace scan {
namespace {

// The sphere as a linear problem in centre and r^2 - |c|^2 (Coope 1993): the first guess.
Eigen::Vector4d algebraic_sphere(const Eigen::MatrixX3d& x) {
  Eigen::MatrixX4d a(x.rows(), 4);
  a << 2 * x, Eigen::VectorXd::Ones(x.rows());
  Eigen::Vector4d sphere = fit_step(a, x.rowwise().squaredNorm(), "sphere");
  sphere(3) = std::sqrt(sphere(3) + sphere.head<3>().squaredNorm());
  return sphere;
}

Eigen::VectorXd sphere_residuals(const Eigen::MatrixX3d& x, const Eigen::Vector4d& sphere) {
  return (x.rowwise() - sphere.head<3>().transpose()).rowwise().norm().array() - sphere(3);
}

}  // namespace

// Gauss-Newton on the residuals |x - c| - r.
SphereFit fit_sphere(std::span<const Eigen::Vector3d> points) {
  const FitPoints scaled = fit_points(points, 4, "sphere");
  const Eigen::MatrixX3d& x = scaled.points;
  Eigen::Vector4d sphere = algebraic_sphere(x);
  bool converged = false;
  for (int iteration = 0; iteration < 100 && !converged; ++iteration) {
    const Eigen::MatrixX3d from_centre = x.rowwise() - sphere.head<3>().transpose();
    Eigen::MatrixX4d jacobian(x.rows(), 4);
    jacobian << -from_centre.rowwise().normalized(), -Eigen::VectorXd::Ones(x.rows());
    const Eigen::Vector4d step = fit_step(jacobian, -sphere_residuals(x, sphere), "sphere");
    sphere += step;
    converged = step.norm() < 1e-12 * (1 + sphere.norm());
  }
  if (!converged || !(sphere(3) > 0)) throw_undetermined("sphere");
  return {scaled.centroid_m + scaled.scale_m * sphere.head<3>(), scaled.scale_m * sphere(3),
          scaled.scale_m *
              std::sqrt(sphere_residuals(x, sphere).squaredNorm() / static_cast<double>(x.rows()))};
}

// The direction of least variance, by singular values rather than by the squared matrix.
PlaneFit fit_plane(std::span<const Eigen::Vector3d> points) {
  const FitPoints scaled = fit_points(points, 3, "plane");
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled.points, Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  if (!(singular(1) > smallest_fit_ratio * singular(0))) throw_undetermined("plane");
  if (!(singular(2) < (1 - smallest_fit_ratio) * singular(1))) throw_undetermined("plane");
  return {scaled.centroid_m, svd.matrixV().col(2),
          scaled.scale_m * singular(2) / std::sqrt(static_cast<double>(points.size()))};
}

}  // namespace scan
