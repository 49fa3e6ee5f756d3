// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The poses of many scans together, by the quadratic forms of their couples: one step, the motions
// that the data leave open, and the covariance. The forms are linear in the twists, so each is one
// sparse factorisation.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "libscan/align/joint_pairs.h"
#include "libscan/align/joint_prior.h"
#include "libscan/core/stated_poses.h"

namespace scan {

// Where each scan's twist is about, along the world's axes, and the unit of all translations. Scans
// that are not free stay.
struct JointFrame {
  std::vector<Eigen::Vector3d> centres;
  double size_m = 1;
  std::vector<bool> free;
};

// Columns over the twists of all scans, six rows each, in their order.
using JointBasis = Eigen::MatrixXd;

// Orthonormal basis of the motions of all scans together that noise alone may feign to be fixed:
// those with v^T A v < (1 + e) v^T N v (observability.h), A and N summed over the forms; e is five
// standard deviations of what chance makes of it where nothing is fixed.
// Sylvester's law of inertia counts them by the pivots of A - (1 + e) N; subspace iteration finds
// them; of more than 48 only what single scans may do, the others held, is found.
JointBasis joint_weak_motions(std::span<const JointForm> forms, const JointFrame& frame);

// Twists that minimise the sum of the forms, with no part along `weak`; with a prior, what is most
// likely of the part that is not along `weak` (joint_prior.h). Zero for scans that are not free or
// in no form.
std::vector<Vector6> joint_step(std::span<const JointForm> forms, const JointFrame& frame,
                                const JointBasis& weak, const GuessPrior& prior = {});

// What twists change between a scan and those that it is coupled to. How far all of them move
// together says nothing: a chain of many may still sway where each couple has long settled.
struct RelativeStep {
  double square = 0;        // of its length in standard errors, the other couples free
  double rotation_rad = 0;  // largest over the couples, and
  double translation = 0;   // in units of the couple's size
};
std::vector<RelativeStep> relative_steps(std::span<const JointForm> forms, const JointFrame& frame,
                                         std::span<const Vector6> twists);

// The part of `weak` that is this scan's own: motions of its block that are not small against the
// other scans'.
TwistBasis weak_motions_of(std::size_t scan, const JointBasis& weak);

struct JointCovariances {
  std::vector<std::optional<Matrix6>> of_scan;
  std::vector<std::optional<Matrix6>> from_guess;  // the part along weak motions
  std::vector<CommonCovariance> between;  // of all couples of scans that have one and are free
};

// Covariance of each scan's twist (rad, m), B^-1 M B^-1 with the curvature B and the scatter M of
// the pulls, summed over all couples at one place first: so noise that the couples of one scan, or
// both directions of a couple, have in common counts (Huber 1967; Liang and Zeger 1986). What
// places share is a number for each scan (shared_noise.h), by whose root its pulls are longer: a
// scatter of patches wide enough to hold it would have so few that its inverse is too large by
// half. With a prior its information is added to both B and M and the weak motions add W Q W^T
// (joint_prior.h). None for scans that are free and in no form, or weak and without a prior.
JointCovariances joint_covariances(std::span<const JointForm> forms,
                                   std::span<const JointDetail> details, const JointFrame& frame,
                                   const JointBasis& weak, const GuessPrior& prior = {});

}  // namespace scan
