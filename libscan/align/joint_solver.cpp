// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr double rounding_share = 1e-10;  // as in observability.cpp

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
JointMatrix block_projector(const Eigen::MatrixXd& weak) {
  JointEntries entries;
  for (Eigen::Index row = 0; row < weak.rows(); row += 6) {
    const auto own = weak.middleRows<6>(row);
    const Matrix6 block = Matrix6::Identity() - own * own.transpose();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) entries.push_back({int(row) + i, int(row) + j, block(i, j)});
  }
  JointMatrix projector(weak.rows(), weak.rows());
  projector.setFromTriplets(entries.begin(), entries.end());
  return projector;
}

// Gram and Schmidt's. Columns of different scans meet nowhere, which keeps the work of many small.
JointMatrix orthonormal(const JointMatrix& columns) {
  std::vector<Eigen::SparseVector<double>> basis;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    Eigen::SparseVector<double> rest = columns.col(k);
    for (const auto& before : basis)
      if (const double along = before.dot(rest); along != 0) rest -= along * before;
    basis.push_back(rest / rest.norm());
  }
  JointMatrix all(columns.rows(), columns.cols());
  for (Eigen::Index k = 0; k < columns.cols(); ++k) all.col(k) = basis[std::size_t(k)];
  return all;
}

}  // namespace

Eigen::MatrixXd withheld(const JointSystem& system, const JointBasis& weak,
                         const GuessPrior& prior) {
  const Eigen::MatrixXd motions = system.reduced(weak);
  if (!prior.known() || weak.cols() == 0) return motions;
  const JointMatrix information = matrix_of(system, system.information(prior));
  return orthonormal(information * JointMatrix(motions.sparseView()));
}

JointMatrix matrix_of(const JointSystem& system, const JointEntries& entries) {
  JointMatrix matrix(system.rows(), system.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

JointMatrix least_diagonal(const JointMatrix& a) {
  constexpr double share = 1e-14;
  JointMatrix diagonal(a.rows(), a.cols());
  diagonal.setIdentity();
  const double least = std::max(1e-3 * a.diagonal().mean(), 1e-300);
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    diagonal.coeffRef(i, i) = share * std::max(a.coeff(i, i), least);
  return diagonal;
}

struct JointFactor::Cholesky {
  Eigen::SimplicialLDLT<JointMatrix> ldlt;
};

JointFactor::JointFactor(const JointMatrix& a) : cholesky_(std::make_unique<Cholesky>()) {
  cholesky_->ldlt.compute(a);
  if (cholesky_->ldlt.info() != Eigen::Success)
    throw Error(Trouble::computation, "align_scans: the joint system is singular");
}

JointFactor::~JointFactor() = default;

Eigen::MatrixXd JointFactor::solve(const Eigen::MatrixXd& b) const {
  return cholesky_->ldlt.solve(b);
}

Eigen::Index JointFactor::negatives() const {
  return (cholesky_->ldlt.vectorD().array() < 0).count();
}

WithholdingSolver::WithholdingSolver(const JointMatrix& a, Eigen::MatrixXd weak)
    : weak_(std::move(weak)) {
  blocks_ = weak_.cols() > 0 && each_of_one_scan(weak_);
  if (!blocks_) {
    held_ = a + least_diagonal(a);
    factor_ = std::make_unique<JointFactor>(held_);
    if (weak_.cols() == 0) return;
    reply_ = factor_->solve(weak_);
    response_.compute(weak_.transpose() * reply_);
    return;
  }
  projector_ = block_projector(weak_);
  JointMatrix rest(a.rows(), a.cols());
  rest.setIdentity();
  const double scale = std::max(a.diagonal().mean(), 1e-300);
  held_ = projector_ * a * projector_ + scale * (rest - projector_);
  held_ += least_diagonal(held_);
  factor_ = std::make_unique<JointFactor>(held_);
}

Eigen::MatrixXd WithholdingSolver::solve(const Eigen::MatrixXd& b) const {
  if (blocks_) return projector_ * factor_->solve(Eigen::MatrixXd(projector_ * b));
  if (weak_.cols() == 0) return factor_->solve(b);
  // What b has along them changes nothing but the size of what cancels.
  const Eigen::MatrixXd x = factor_->solve(b - weak_ * (weak_.transpose() * b));
  return x - reply_ * response_.solve(weak_.transpose() * x);
}

// With G = F - R K R^T, F the factor's inverse, R = F W and K = (W^T R)^-1, G M G is F M F less
// R K U^T and its transpose, U = F M R, plus R K (R^T M R) K R^T.
std::vector<Matrix6> WithholdingSolver::sandwich_blocks(const JointMatrix& m,
                                                        std::span<const BlockAt> places) const {
  if (blocks_) return scan::sandwich_blocks(held_, projector_ * m * projector_, places);
  std::vector<Matrix6> blocks = scan::sandwich_blocks(held_, m, places);
  if (weak_.cols() == 0) return blocks;
  const Eigen::MatrixXd spread = m * reply_, u = factor_->solve(spread);
  const Eigen::MatrixXd both = response_.solve(reply_.transpose());  // K R^T
  const Eigen::MatrixXd inner = reply_.transpose() * spread;
  const auto columns = [&](std::size_t k) { return both.middleCols<6>(6 * Eigen::Index(k)); };
  const auto rows = [&](std::size_t k) { return u.middleRows<6>(6 * Eigen::Index(k)); };
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto& [i, j] = places[k];
    blocks[k] += columns(i).transpose() * inner * columns(j) - rows(i) * columns(j) -
                 (rows(j) * columns(i)).transpose();
  }
  return blocks;
}

}  // namespace scan
