// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The sparse normal equations that the forms of many couples of scans make together.
#pragma once

#include <map>

#include "libscan/align/joint_refinement.h"

namespace scan {

// Carries a scan's twist to the form's centre and unit.
Matrix6 twist_to_form(const JointFrame& frame, std::size_t scan, const JointForm& form);

// What rounding may feign in a matrix of a form. Of the form, not of the whole system: a bend of a
// chain of n scans, most of which each of its couples sees n^-4 of, is as well known as the couples
// are.
Matrix6 rounding_of(const Matrix6& matrix);

// One entry of a sparse matrix; entries at the same place add up.
struct JointEntry {
  int at_row = 0, at_column = 0;
  double summand = 0;
  int row() const { return at_row; }
  int col() const { return at_column; }
  double value() const { return summand; }
};
using JointEntries = std::vector<JointEntry>;

// What is seen at each place pulls each scan there with.
using PlacePulls = std::map<std::array<std::int64_t, 3>, std::map<std::size_t, Vector6>>;

// Six unknowns for each scan that is free and in a form; both arguments outlive it.
class JointSystem {
 public:
  JointSystem(std::span<const JointForm> forms, const JointFrame& frame);

  Eigen::Index rows() const { return rows_; }
  bool has(std::size_t scan) const { return row_[scan] >= 0; }
  Eigen::Index row(std::size_t scan) const { return row_[scan]; }

  // Sum of (x_source - x_target)^T Q (x_source - x_target), Q a matrix of the form.
  template <class Choice>
  JointEntries sum(Choice&& matrix_of) const {
    std::vector<Matrix6> matrices;
    for (const JointForm& form : forms_) matrices.push_back(matrix_of(form));
    return assemble(matrices);
  }
  JointEntries sum_of(std::span<const JointDetail> details) const;  // of their curvatures
  Eigen::VectorXd right_side() const;

  // E^-1 and E^-1 e of a prior; zero of none.
  JointEntries information(const GuessPrior& prior) const;
  Eigen::VectorXd right_side(const GuessPrior& prior) const;

  // The pulls of all forms, each times its form's factor: what it pulls the source with, it pulls
  // the target back with.
  PlacePulls pulls_by_place(std::span<const JointDetail> details,
                            std::span<const double> factors) const;
  // Sum over all places of g g^T, g the pulls there on all scans.
  JointEntries scatter(const PlacePulls& places) const;

  // Between the unknowns and the twists of all scans.
  std::vector<Vector6> twists(const Eigen::VectorXd& x) const;
  JointBasis expanded(const Eigen::MatrixXd& columns) const;
  Eigen::MatrixXd reduced(const JointBasis& columns) const;

 private:
  JointEntries assemble(std::span<const Matrix6> matrices) const;

  std::span<const JointForm> forms_;
  const JointFrame& frame_;
  std::vector<Eigen::Index> row_;  // first one of each scan; -1: none
  Eigen::Index rows_ = 0;
};

}  // namespace scan
