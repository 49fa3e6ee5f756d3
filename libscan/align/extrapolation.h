// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where the steps of an iteration lead to, from what came of the last ones.
#pragma once

#include "libscan/core/pose.h"

namespace scan {

// Speeds up x -> x + f(x) towards f = 0 (Anderson 1965, in the form of Walker and Ni 2011, eq.
// 2.2): the moves so far and what they changed of f tell how f goes on along them. Of a linear f in
// d dimensions d + 1 moves end there.
class Extrapolation {
 public:
  // The move to make in place of `step` = f(x), the moves before having been made. Sizes are roots
  // of v^T metric v; a change of f below `least_change` may be noise and teaches nothing.
  Vector6 move(const Vector6& step, const Matrix6& metric, double least_change);

 private:
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
  Columns moves_{6, 0}, changes_{6, 0};
  Vector6 last_move_ = Vector6::Zero(), last_step_ = Vector6::Zero();
};

}  // namespace scan
