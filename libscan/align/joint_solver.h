// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Sparse solves for the poses of many scans together, some motions of which are withheld.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "libscan/align/joint_system.h"
#include "libscan/align/selected_inverse.h"

namespace scan {

using JointMatrix = Eigen::SparseMatrix<double>;

JointMatrix matrix_of(const JointSystem& system, const JointEntries& entries);

// What is added to A so that scans which no chain of couples ties to one that is held stay where
// they are: of the diagonal little more than its rounding, since the least eigenvalue of a chain of
// n scans falls with n^-4.
JointMatrix least_diagonal(const JointMatrix& a);

// Orthonormal basis of what must not be in a step: of the weak motions W, or with a prior of
// E^-1 W (joint_prior.h).
Eigen::MatrixXd withheld(const JointSystem& system, const JointBasis& weak,
                         const GuessPrior& prior);

// L D L^T of a symmetric matrix. Throws scan::Error (computation) for a singular one.
class JointFactor {
 public:
  explicit JointFactor(const JointMatrix& a);
  ~JointFactor();
  JointFactor(const JointFactor&) = delete;
  JointFactor& operator=(const JointFactor&) = delete;

  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  Eigen::Index negatives() const;  // eigenvalues below zero, by Sylvester's law of inertia

 private:
  struct Cholesky;
  std::unique_ptr<Cholesky> cholesky_;
};

// Solutions of A x = b in least squares with no part along orthonormal `weak` motions. Where each
// is of one scan, with P = I - W W^T these are (P A P + s W W^T)^-1 P b for any s, as sparse as A;
// few of many scans are taken out of A^-1 b.
class WithholdingSolver {
 public:
  WithholdingSolver(const JointMatrix& a, Eigen::MatrixXd weak);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
  // Those blocks of G M G, G b being the solution of A x = b.
  std::vector<Matrix6> sandwich_blocks(const JointMatrix& m, std::span<const BlockAt> places) const;

 private:
  Eigen::MatrixXd weak_;
  bool blocks_ = false;
  JointMatrix projector_, held_;
  std::unique_ptr<JointFactor> factor_;
  Eigen::MatrixXd reply_;
  Eigen::LDLT<Eigen::MatrixXd> response_;
};

}  // namespace scan
