// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The rigid motion that best carries one point set onto another.
#pragma once

#include <span>

#include "libscan/core/pose.h"

namespace scan {

struct RigidFit {
  Pose target_from_source = Pose::Identity();
  int rank =
      0;  // of the centred cross-covariance: 3 or 2 determine the motion, 1 leaves a turn free
  double rms_m = 0;
};

// Weighted least squares by singular value decomposition (Arun, Huang, Blostein 1987, with the
// determinant guard of Umeyama 1991): a proper rotation always, det = +1. Pairs are source[i],
// target[i]; `weights` empty or one per pair, not negative. Collinear pairs get the smallest
// rotation that fits; no pairs give the identity with rank 0. Throws scan::Error (input) for
// unequal lengths or numbers that are not finite.
RigidFit rigid_fit(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target,
                   std::span<const double> weights = {});

}  // namespace scan
