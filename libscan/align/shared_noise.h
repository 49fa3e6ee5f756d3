// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How much noise neighbours share.
#pragma once

#include <Eigen/Core>
#include <span>

#include "libscan/core/pose.h"

namespace scan {

// An estimate of the variance of the sum of `pulls` over the sum of their variances: of so many
// pairs all but one are idle. Its inverse has the right mean, so that of noise of their own, where
// the truth is 1, it is now above, now below. `pulls` lie at `at`, metres, sum to
// zero (an estimate has followed them) and are whitened: the sum of p p^T is the identity in
// `dimensions` of the six coordinates, the others are zero.
//
// The scatter of sums over patches of the surface misses what is shared across their borders, a
// share that falls with the patches' width W: the square root of the ratio is a - b / W for noise
// that reaches less far than W, of which two widths give a.
double noise_sharing(std::span<const Vector6> pulls, std::span<const Eigen::Vector3d> at,
                     int dimensions);

}  // namespace scan
