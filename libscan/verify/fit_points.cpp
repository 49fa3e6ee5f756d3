// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Centring and scaling before a fit, and the steps of its Gauss-Newton iteration.
#include "libscan/verify/fit_points.h"

#include <Eigen/QR>
#include <cmath>
#include <string>

#include "libscan/core/error.h"

namespace scan {

void throw_undetermined(const char* shape) {
  throw Error(Trouble::computation,
              std::string(shape) + " fit: the points do not determine the shape");
}

FitPoints fit_points(std::span<const Eigen::Vector3d> points, std::size_t least,
                     const char* shape) {
  if (points.size() < least)
    throw Error(Trouble::computation, std::string(shape) +
                                          " fit: " + std::to_string(points.size()) +
                                          " points, needs " + std::to_string(least));
  FitPoints scaled{Eigen::MatrixX3d(points.size(), 3), points.front(), 0};
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

Eigen::VectorXd fit_step(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const char* shape) {
  const Eigen::RowVectorXd length = a.colwise().norm();
  if (!(length.minCoeff() > 0) || !length.allFinite()) throw_undetermined(shape);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a * length.cwiseInverse().asDiagonal());
  const Eigen::VectorXd diagonal = qr.matrixR().diagonal().cwiseAbs();
  if (!(diagonal(a.cols() - 1) > smallest_fit_ratio * diagonal(0))) throw_undetermined(shape);
  return qr.solve(b).cwiseQuotient(length.transpose());
}

}  // namespace scan
