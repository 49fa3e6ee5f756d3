// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/extrapolation.h"

#include <Eigen/QR>

namespace scan {
namespace {

// More columns than dimensions would repeat what is known: the oldest gives way.
template <class Columns>
void append(Columns& columns, const Vector6& last) {
  if (columns.cols() == columns.rows())
    columns.template leftCols<5>() = columns.template rightCols<5>().eval();
  else
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
  columns.template rightCols<1>() = last;
}

}  // namespace

Vector6 Extrapolation::move(const Vector6& step, const Matrix6& metric, double least_change) {
  const Vector6 change = step - last_step_;
  if (!last_move_.isZero(0) && change.dot(metric * change) > least_change * least_change) {
    append(moves_, last_move_);
    append(changes_, change);
  }
  last_step_ = last_move_ = step;
  if (moves_.cols() == 0) return step;
  const Eigen::MatrixXd weighted = changes_.transpose() * metric;
  const Eigen::VectorXd shares =
      Eigen::MatrixXd(weighted * changes_).completeOrthogonalDecomposition().solve(weighted * step);
  last_move_ = step - (moves_ + changes_) * shares;
  return last_move_;
}

}  // namespace scan
