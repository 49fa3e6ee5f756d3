// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Finite motions of many scans that are coupled: what twists of all of them do between two.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "libscan/align/joint_refinement.h"

namespace scan {

// Carries the twists of all scans, six rows each, to those of each form's source against its
// target, about the form's centre.
Eigen::SparseMatrix<double> relative_twists(std::span<const JointForm> forms,
                                            const JointFrame& frame);

// The twist of a form's source against its target, about the form's centre and in its size, that
// brings them from where they lie `before` to where they lie `after`.
Vector6 relative_twist(const JointForm& form, std::span<const Pose> before,
                       std::span<const Pose> after);

// The poses after `twists`, those of coupled scans to each other as the twists say, to all orders:
// a turn w moves neighbours apart by w^2 / 2 of their distance where each is turned about its own
// centre and shifted, which in a long chain that sways costs them their partners. Gauss and Newton
// over the couples; what loops cannot have is shared among their couples.
std::vector<Pose> moved_together(std::span<const JointForm> forms, const JointFrame& frame,
                                 std::span<const Pose> world_from_local,
                                 std::span<const Vector6> twists);

}  // namespace scan
