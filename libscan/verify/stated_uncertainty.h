// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether errors are as large as their own stated uncertainty says.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libscan/core/point_cloud.h"
#include "libscan/core/stated_poses.h"
#include "libscan/verify/truth.h"
#include "libscan/verify/verdict.h"

namespace scan {

// Squared errors over their stated variances, e^T C^-1 e: chi-square with `degrees` of freedom each
// if the statement is honest (Bar-Shalom et al. 2001, section 5.4: normalised estimation error
// squared).
struct NormalisedErrors {
  std::vector<double> squares;
  int degrees = 1;  // 1 or 6
};

// normalised_<what>_error_rms: root of the mean of the squares over their degrees; 1 is honest,
// more is too proud. Its `expected` is for honest errors that know nothing of each other; where
// neighbours share theirs, as on a surface, honest figures leave it more often than 1 in 20 times.
// <what>_error_within_95: share of the errors inside their own 95 % interval (for six degrees:
// ellipsoid). Nothing for no errors. Throws scan::Error (usage) for other degrees.
std::vector<Measurement> stated_uncertainty(const std::string& what, const NormalisedErrors& errors,
                                            const std::string& over);

// One degree of freedom: the error of a point along the longest axis of its covariance, which is of
// rank one for a distance along a known line. None for a covariance of zero or one that is not
// finite.
std::optional<double> normalised_square(const Eigen::Vector3d& error_m,
                                        const Eigen::Matrix3d& covariance_m2);

// Six degrees of freedom: of each scan with a statement, the pose against that of the anchor, whose
// own pose is held to be right. Throws scan::Error (input) for lists of different lengths and an
// anchor that is none of them.
NormalisedErrors normalised_pose_errors(std::span<const Pose> estimated,
                                        std::span<const Pose> truth,
                                        std::span<const std::optional<StatedPose>> stated,
                                        std::size_t anchor);

// One degree of freedom: deviations over standard errors, where these are positive and finite and
// the support (distance to the nearest data over its spacing) is at most `most_spacings`. Throws
// scan::Error (input) for lists of different lengths.
NormalisedErrors normalised_deviations(std::span<const double> deviations_m,
                                       std::span<const double> standard_errors_m,
                                       std::span<const double> support_spacings,
                                       double most_spacings);

}  // namespace scan
