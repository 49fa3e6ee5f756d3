// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "libscan/align/joint_refinement.h"
#include "libscan/align/joint_solver.h"
#include "libscan/core/error.h"

namespace scan {
namespace {

// Of errors alone A - N, which is the sum over the pairs of products of two normals' errors, has a
// standard deviation of 2 N sqrt(neighbours / n) over n planes: each shares its errors with those
// that its fit has in common with them. What lies five of these above noise is held by the surface.
constexpr double sigmas_above_noise = 5;
constexpr double neighbours = 16;  // PrepareOptions
constexpr int subspace_rounds = 30;
// More weak motions than that are looked for scan by scan, the others held.
constexpr Eigen::Index most_together = 48;
constexpr Eigen::Index spare_columns = 4;
// A scan's part of a weak motion counts from this share of the largest part of any scan.
constexpr double own_share = 0.2;

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

// Planes that each scan's forms were judged by: their normals are unit.
std::vector<double> planes_of(std::span<const JointForm> forms, std::size_t scans) {
  std::vector<double> planes(scans, 0);
  for (const JointForm& form : forms)
    for (const std::size_t scan : {form.source, form.target})
      planes[scan] += form.apparent.bottomRightCorner<3, 3>().trace();
  return planes;
}

double chance_excess(double planes) {
  return 2 * sigmas_above_noise * std::sqrt(neighbours / std::max(planes, 1.0));
}

// The `count` least v^T A v / v^T G v, by inverse iteration on a subspace with Rayleigh-Ritz.
Eigen::MatrixXd least_motions(const JointMatrix& a, const JointMatrix& g, Eigen::Index count) {
  const Eigen::Index columns = std::min(a.rows(), count + spare_columns);
  const JointFactor factor(a + least_diagonal(a));
  Eigen::MatrixXd x(a.rows(), columns);  // any start that has a part of all will do
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (Eigen::Index k = 0; k < columns; ++k)
      x(i, k) = std::sin(1.0 + 0.7 * double(i + 1) * double(k + 1));
  Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
  for (int round = 0; round < subspace_rounds; ++round) {
    x = orthonormal(factor.solve(g * x));
    ritz.compute(x.transpose() * (a * x), x.transpose() * (g * x));
    x = (x * ritz.eigenvectors()).eval();
  }
  return orthonormal(x.leftCols(count));
}

// The motions of each scan by itself with v^T A v < v^T G v.
Eigen::MatrixXd own_motions(const JointMatrix& a, const JointMatrix& g) {
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index row = 0; row < a.rows(); row += 6) {
    const Matrix6 own(a.block(row, row, 6, 6)), limit(g.block(row, row, 6, 6));
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(own, limit);
    const Eigen::Index count = (solver.eigenvalues().array() < 1).count();
    if (count == 0) continue;
    const Eigen::MatrixXd basis = orthonormal(solver.eigenvectors().leftCols(count));
    for (Eigen::Index k = 0; k < count; ++k) {
      columns.push_back(Eigen::VectorXd::Zero(a.rows()));
      columns.back().segment<6>(row) = basis.col(k);
    }
  }
  Eigen::MatrixXd all(a.rows(), Eigen::Index(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) all.col(Eigen::Index(k)) = columns[k];
  return all;
}

}  // namespace

JointBasis joint_weak_motions(std::span<const JointForm> forms, const JointFrame& frame) {
  const JointSystem system(forms, frame);
  const auto none = JointBasis(6 * Eigen::Index(frame.centres.size()), 0);
  if (system.rows() == 0) return none;
  const JointMatrix apparent =
      matrix_of(system, system.sum([](const JointForm& form) { return form.apparent; }));
  const std::vector<double> planes = planes_of(forms, frame.centres.size());
  JointMatrix limit = matrix_of(system, system.sum([&](const JointForm& form) {
    const double fewer = std::min(planes[form.source], planes[form.target]);
    return Matrix6((1 + chance_excess(fewer)) * form.noise + rounding_of(form.apparent));
  }));
  limit += least_diagonal(apparent);
  const Eigen::Index count = JointFactor(apparent - limit).negatives();
  if (count == 0) return none;
  return system.expanded(count > most_together ? own_motions(apparent, limit)
                                               : least_motions(apparent, limit, count));
}

TwistBasis weak_motions_of(std::size_t scan, const JointBasis& weak) {
  if (weak.cols() == 0) return TwistBasis(6, 0);
  std::vector<Vector6> own;
  for (Eigen::Index k = 0; k < weak.cols(); ++k) {
    const Vector6 part = weak.col(k).segment<6>(6 * Eigen::Index(scan));
    if (part.isZero(0)) continue;
    double largest = 0;
    for (Eigen::Index i = 0; i < weak.rows(); i += 6)
      largest = std::max(largest, weak.col(k).segment<6>(i).norm());
    if (part.norm() > own_share * largest) own.push_back(part / largest);
  }
  if (own.empty()) return TwistBasis(6, 0);
  TwistBasis parts(6, Eigen::Index(own.size()));
  for (std::size_t k = 0; k < own.size(); ++k) parts.col(Eigen::Index(k)) = own[k];
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(parts), Eigen::ComputeThinU);
  const Eigen::Index rank = (svd.singularValues().array() > own_share).count();
  return svd.matrixU().leftCols(rank);
}

}  // namespace scan
