// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>

#include "libscan/align/joint_system.h"
#include "libscan/align/shared_noise.h"
#include "libscan/core/error.h"

namespace scan {
namespace {

// Of errors alone A - N, which is the sum over the pairs of products of two normals' errors, has a
// standard deviation of 2 N sqrt(neighbours / n) over n planes: each shares its errors with those
// that its fit has in common with them. What lies five of these above noise is held by the surface.
constexpr double sigmas_above_noise = 5;
constexpr double neighbours = 16;         // PrepareOptions
constexpr double rounding_share = 1e-10;  // as in observability.cpp
constexpr int subspace_rounds = 30;
// More weak motions than that are looked for scan by scan, the others held.
constexpr Eigen::Index most_together = 48;
constexpr Eigen::Index spare_columns = 4;
// A scan's part of a weak motion counts from this share of the largest part of any scan.
constexpr double own_share = 0.2;

using Sparse = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLDLT<Sparse>;

Sparse matrix_of(const JointSystem& system, const JointEntries& entries) {
  Sparse matrix(system.rows(), system.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// A + a share of its diagonal, so that what nothing holds stays where it is.
std::unique_ptr<Factor> damped_factor(const Sparse& a, double share) {
  Sparse damped = a;
  const double least = 1e-3 * a.diagonal().mean();
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    damped.coeffRef(i, i) += share * std::max(a.coeff(i, i), least);
  auto factor = std::make_unique<Factor>(damped);
  if (factor->info() != Eigen::Success)
    throw Error(Trouble::computation, "align_scans: the joint system is singular");
  return factor;
}

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
Eigen::MatrixXd least_motions(const Sparse& a, const Sparse& g, Eigen::Index count) {
  const Eigen::Index columns = std::min(a.rows(), count + spare_columns);
  const auto factor = damped_factor(a, rounding_share);
  Eigen::MatrixXd x(a.rows(), columns);  // any start that has a part of all will do
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (Eigen::Index k = 0; k < columns; ++k)
      x(i, k) = std::sin(1.0 + 0.7 * double(i + 1) * double(k + 1));
  Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
  for (int round = 0; round < subspace_rounds; ++round) {
    x = orthonormal(factor->solve(Eigen::MatrixXd(g * x)));
    ritz.compute(x.transpose() * (a * x), x.transpose() * (g * x));
    x = (x * ritz.eigenvectors()).eval();
  }
  return orthonormal(x.leftCols(count));
}

// The motions of each scan by itself with v^T A v < v^T G v.
Eigen::MatrixXd own_motions(const Sparse& a, const Sparse& g) {
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

// Whether each column is a motion of one scan.
bool each_of_one_scan(const Eigen::MatrixXd& columns) {
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    Eigen::Index first = 0;
    columns.col(k).cwiseAbs().maxCoeff(&first);
    const double own = columns.col(k).segment<6>(first - first % 6).squaredNorm();
    if (own < (1 - rounding_share) * columns.col(k).squaredNorm()) return false;
  }
  return true;
}

// I - W W^T, block by block.
Sparse block_projector(const Eigen::MatrixXd& weak) {
  JointEntries entries;
  for (Eigen::Index row = 0; row < weak.rows(); row += 6) {
    const auto own = weak.middleRows<6>(row);
    const Matrix6 block = Matrix6::Identity() - own * own.transpose();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) entries.push_back({int(row) + i, int(row) + j, block(i, j)});
  }
  Sparse projector(weak.rows(), weak.rows());
  projector.setFromTriplets(entries.begin(), entries.end());
  return projector;
}

// Solutions of A x = b in least squares with no part along orthonormal `weak` motions. Where each
// is of one scan, with P = I - W W^T these are (P A P + s W W^T)^-1 P b for any s, as sparse as A;
// few of many scans are taken out of A^-1 b.
class WithholdingSolver {
 public:
  WithholdingSolver(const Sparse& a, Eigen::MatrixXd weak) : weak_(std::move(weak)) {
    blocks_ = weak_.cols() > 0 && each_of_one_scan(weak_);
    if (!blocks_) {
      factor_ = damped_factor(a, rounding_share);
      if (weak_.cols() == 0) return;
      reply_ = factor_->solve(weak_);
      response_.compute(weak_.transpose() * reply_);
      return;
    }
    projector_ = block_projector(weak_);
    Sparse rest(a.rows(), a.cols());
    rest.setIdentity();
    const double scale = std::max(a.diagonal().mean(), 1e-300);
    const Sparse held = projector_ * a * projector_;
    factor_ = damped_factor(held + scale * (rest - projector_), rounding_share);
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const {
    if (blocks_) return projector_ * factor_->solve(Eigen::MatrixXd(projector_ * b));
    const Eigen::MatrixXd x = factor_->solve(b);
    if (weak_.cols() == 0) return x;
    return x - reply_ * response_.solve(weak_.transpose() * x);
  }

 private:
  Eigen::MatrixXd weak_;
  bool blocks_ = false;
  Sparse projector_;
  std::unique_ptr<Factor> factor_;
  Eigen::MatrixXd reply_;
  Eigen::LDLT<Eigen::MatrixXd> response_;
};

// What each scan's noise shared among places adds to its scatter (shared_noise.h), along all that
// is not weak.
std::vector<double> noise_shares(const PlacePulls& places, std::size_t scans,
                                 const JointBasis& weak) {
  std::vector<std::vector<Vector6>> pulls(scans);
  std::vector<std::vector<Eigen::Vector3d>> at(scans);
  for (const auto& [place, all] : places)
    for (const auto& [scan, pull] : all) {
      pulls[scan].push_back(pull);
      at[scan].emplace_back(double(place[0]), double(place[1]), double(place[2]));
    }
  std::vector<double> shares(scans, 1);
  for (std::size_t i = 0; i < scans; ++i) {
    Matrix6 scatter = Matrix6::Zero();
    const Matrix6 rest = complement_projector(weak_motions_of(i, weak));
    for (Vector6& pull : pulls[i]) {
      pull = (rest * pull).eval();
      scatter += pull * pull.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scatter);
    Vector6 roots = Vector6::Zero();
    for (int k = 0; k < 6; ++k)
      if (const double variance = solver.eigenvalues()[k];
          variance > rounding_share * solver.eigenvalues()[5])
        roots[k] = 1 / std::sqrt(variance);
    const auto dimensions = static_cast<int>((roots.array() > 0).count());
    if (dimensions == 0) continue;
    const Matrix6 whitening = roots.asDiagonal() * solver.eigenvectors().transpose();
    for (Vector6& pull : pulls[i]) pull = (whitening * pull).eval();
    // Not below what each point errs by alone: chance must not make all ties of a scan surer.
    shares[i] = std::max(1.0, noise_sharing(pulls[i], at[i], dimensions));
  }
  return shares;
}

}  // namespace

JointBasis joint_weak_motions(std::span<const JointForm> forms, const JointFrame& frame,
                              double least_excess) {
  const JointSystem system(forms, frame);
  const auto none = JointBasis(6 * Eigen::Index(frame.centres.size()), 0);
  if (system.rows() == 0) return none;
  const Sparse apparent =
      matrix_of(system, system.sum([](const JointForm& form) { return form.apparent; }));
  const std::vector<double> planes = planes_of(forms, frame.centres.size());
  Sparse limit = matrix_of(system, system.sum([&](const JointForm& form) {
    const double fewer = std::min(planes[form.source], planes[form.target]);
    return Matrix6((1 + std::max(least_excess, chance_excess(fewer))) * form.noise);
  }));
  const double least = rounding_share * std::max(apparent.diagonal().mean(), 1e-300);
  for (Eigen::Index i = 0; i < limit.rows(); ++i) limit.coeffRef(i, i) += least;
  const Factor factor(apparent - limit);
  if (factor.info() != Eigen::Success)
    throw Error(Trouble::computation, "align_scans: the joint information is singular");
  const Eigen::Index count = (factor.vectorD().array() < 0).count();
  if (count == 0) return none;
  return system.expanded(count > most_together ? own_motions(apparent, limit)
                                               : least_motions(apparent, limit, count));
}

std::vector<Vector6> joint_step(std::span<const JointForm> forms, const JointFrame& frame,
                                const JointBasis& weak) {
  const JointSystem system(forms, frame);
  if (system.rows() == 0) return std::vector<Vector6>(frame.centres.size(), Vector6::Zero());
  const WithholdingSolver solver(
      matrix_of(system, system.sum([](const JointForm& form) { return form.a; })),
      system.reduced(weak));
  return system.twists(solver.solve(system.right_side()));
}

std::vector<double> squared_steps(std::span<const JointForm> forms, const JointFrame& frame,
                                  std::span<const Vector6> twists) {
  std::vector<double> squares(twists.size(), 0);
  for (const JointForm& form : forms)
    for (const std::size_t scan : {form.source, form.target}) {
      const Vector6 x = twist_to_form(frame, scan, form) * twists[scan];
      squares[scan] += x.dot(form.a * x);
    }
  return squares;
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

std::vector<std::optional<Matrix6>> joint_covariances(std::span<const JointForm> forms,
                                                      std::span<const JointDetail> details,
                                                      const JointFrame& frame,
                                                      const JointBasis& weak) {
  std::vector<std::optional<Matrix6>> covariances(frame.centres.size());
  for (std::size_t i = 0; i < covariances.size(); ++i)
    if (!frame.free[i]) covariances[i] = Matrix6::Zero();
  const JointSystem system(forms, frame);
  if (system.rows() == 0) return covariances;
  const WithholdingSolver solver(matrix_of(system, system.sum_of(details)), system.reduced(weak));
  const PlacePulls places = system.pulls_by_place(details);
  const Sparse scatter =
      matrix_of(system, system.scatter(places, noise_shares(places, covariances.size(), weak)));
  Matrix6 units = Matrix6::Identity();
  units.bottomRightCorner<3, 3>() *= frame.size_m;
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    if (!system.has(i) || weak_motions_of(i, weak).cols() > 0) continue;
    Eigen::MatrixXd reply = Eigen::MatrixXd::Zero(system.rows(), 6);
    reply.middleRows<6>(system.row(i)).setIdentity();
    reply = solver.solve(reply);
    const Matrix6 covariance = reply.transpose() * (scatter * reply);
    covariances[i] = units * (0.5 * (covariance + covariance.transpose())) * units;
  }
  return covariances;
}

}  // namespace scan
