// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far a surface is off across itself: what the errors of its points move it by, those that
// points have in common counted as such, and what smoothing takes from it.
#pragma once

#include <span>
#include <vector>

#include "libscan/core/scan.h"
#include "libscan/core/stated_poses.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

// What the points of a cloud have in common.
struct CommonErrors {
  std::vector<std::uint32_t> scan;  // of each point; empty: all are of one
  // Row and column of each point's ray, in noise windows (Scan): of two points of a scan the noise
  // is correlated by the product of 1 - |difference|, and not at all from 1 on. Empty: each has its
  // own.
  std::vector<Eigen::Vector2d> in_windows;
  StatedPoses poses;  // of the scans; without any they are held to be right
};

// Of the points of all scans one after the other.
CommonErrors common_errors(std::span<const Scan> scans, StatedPoses poses);

// Those of the points of the given indices.
CommonErrors subset(const CommonErrors& common, std::span<const std::uint32_t> indices);

// Variances of a vertex across the surface. The surface there is held to be the mean of the points
// around it, p_i, weighed by w_i (surface_weights.h); n is its normal.
struct SurfaceVariance {
  // Sum of w_i w_j s_i s_j r_ij, s_i^2 = n^T C_i n with the point's covariance (without one its
  // sigma, without that the surface's sigma_m), r_ij their correlation.
  double points_m2 = 0;
  // Sum over scans a, b of J_a^T C_ab J_b, J_a the sum of w_i ((p_i - c_a) x n, n) over a's points,
  // C_ab the covariance of the motions of a and b; where it is not stated |J_a^T C_ab J_b| is at
  // its largest, the root of the product of both scans' own. Infinite with a scan whose covariance
  // is not known. The anchor of the alignment is held to be right.
  double poses_m2 = 0;
  double smoothing_m2 = 0;  // expected square of what smoothing took (surface_weights.h)
  double total_m2() const { return points_m2 + poses_m2 + smoothing_m2; }
};

// Of each vertex of a surface that knows its vertices' smoothing lengths; none of others. `cloud`:
// the points it was made from, world; those that are not finite do not count. Throws scan::Error
// (input) for lists of different lengths and a scan without a stated pose among some.
std::vector<SurfaceVariance> surface_variances(const SurfaceResult& surface,
                                               const PointCloud& cloud, const CommonErrors& common);

// Sets standard_error_m to the roots of their totals.
void add_standard_errors(SurfaceResult& surface, const PointCloud& cloud,
                         const CommonErrors& common);

}  // namespace scan
