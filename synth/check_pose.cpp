// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/check_pose.h"

#include "libscan/core/error.h"
#include "libscan/core/shortest.h"

namespace scan::synth {

void check_pose(const Pose& pose, const std::string& field) {
  if (!pose.matrix().allFinite()) throw Error(Trouble::input, field + " is not finite");
  const Eigen::Matrix3d r = pose.linear();
  const double error = (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 1e-9 || r.determinant() < 0)
    throw Error(Trouble::input, field + " is no rigid motion: R^T R differs from 1 by " +
                                    shortest(error) + ", at most 1e-9");
}

}  // namespace scan::synth
