// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Orthogonal-distance fits in coordinates that are centred and scaled first.
#include "libscan/verify/fit.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

// Below this ratio of singular values the points leave a parameter of the shape free. Rounding of
// scaled coordinates is 1e-16; a spherical cap of half-angle t has a ratio of about t^2 / 10.
constexpr double smallest_ratio = 1e-9;

struct Scaled {
  Eigen::MatrixX3d points;  // one per row, centroid 0, root mean square length 1
  Eigen::Vector3d centroid_m;
  double scale_m = 0;
};

Scaled centred_and_scaled(std::span<const Eigen::Vector3d> points, std::size_t least,
                          const char* shape) {
  if (points.size() < least)
    throw Error(Trouble::computation, std::string(shape) +
                                          " fit: " + std::to_string(points.size()) +
                                          " points, needs " + std::to_string(least));
  Scaled scaled{Eigen::MatrixX3d(points.size(), 3), points.front(), 0};
  for (std::size_t i = 0; i < points.size(); ++i)
    scaled.points.row(static_cast<Eigen::Index>(i)) = (points[i] - points.front()).transpose();
  const Eigen::RowVector3d mean = scaled.points.colwise().mean();
  scaled.points.rowwise() -= mean;
  scaled.centroid_m += mean.transpose();
  scaled.scale_m = std::sqrt(scaled.points.rowwise().squaredNorm().mean());
  if (!(scaled.scale_m > 0) || !std::isfinite(scaled.scale_m))
    throw Error(Trouble::computation,
                std::string(shape) + " fit: the points coincide or are not finite");
  scaled.points /= scaled.scale_m;
  return scaled;
}

[[noreturn]] void throw_undetermined(const char* shape) {
  throw Error(Trouble::computation,
              std::string(shape) + " fit: the points do not determine the shape");
}

// Least-squares solution of a x = b, refused when a column combination is free.
Eigen::Vector4d solve(const Eigen::MatrixX4d& a, const Eigen::VectorXd& b) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX4d> qr(a);
  const Eigen::Vector4d diagonal = qr.matrixR().diagonal().cwiseAbs();
  if (!(diagonal(3) > smallest_ratio * diagonal(0))) throw_undetermined("sphere");
  return qr.solve(b);
}

// The sphere as a linear problem in centre and r^2 - |c|^2 (Coope 1993): the first guess.
Eigen::Vector4d algebraic_sphere(const Eigen::MatrixX3d& x) {
  Eigen::MatrixX4d a(x.rows(), 4);
  a << 2 * x, Eigen::VectorXd::Ones(x.rows());
  Eigen::Vector4d sphere = solve(a, x.rowwise().squaredNorm());
  sphere(3) = std::sqrt(sphere(3) + sphere.head<3>().squaredNorm());
  return sphere;
}

Eigen::VectorXd sphere_residuals(const Eigen::MatrixX3d& x, const Eigen::Vector4d& sphere) {
  return (x.rowwise() - sphere.head<3>().transpose()).rowwise().norm().array() - sphere(3);
}

}  // namespace

// Gauss-Newton on the residuals |x - c| - r.
SphereFit fit_sphere(std::span<const Eigen::Vector3d> points) {
  const Scaled scaled = centred_and_scaled(points, 4, "sphere");
  const Eigen::MatrixX3d& x = scaled.points;
  Eigen::Vector4d sphere = algebraic_sphere(x);
  bool converged = false;
  for (int iteration = 0; iteration < 100 && !converged; ++iteration) {
    const Eigen::MatrixX3d from_centre = x.rowwise() - sphere.head<3>().transpose();
    Eigen::MatrixX4d jacobian(x.rows(), 4);
    jacobian << -from_centre.rowwise().normalized(), -Eigen::VectorXd::Ones(x.rows());
    const Eigen::Vector4d step = solve(jacobian, -sphere_residuals(x, sphere));
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
  const Scaled scaled = centred_and_scaled(points, 3, "plane");
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled.points, Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  if (!(singular(1) > smallest_ratio * singular(0))) throw_undetermined("plane");
  if (!(singular(2) < (1 - smallest_ratio) * singular(1))) throw_undetermined("plane");
  return {scaled.centroid_m, svd.matrixV().col(2),
          scaled.scale_m * singular(2) / std::sqrt(static_cast<double>(points.size()))};
}

}  // namespace scan
