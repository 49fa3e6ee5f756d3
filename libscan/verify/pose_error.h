// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far estimated poses are from the true ones.
#pragma once

#include <span>
#include <vector>

#include "libscan/core/pose.h"
#include "libscan/verify/verdict.h"

namespace scan {

struct PoseError {
  double rotation_rad = 0;
  double translation_m = 0;  // at the centroid of the scan's points
  double moved_points_rms_m = 0;
};

// Per scan, after the one rigid motion of the whole set (weighted by points) that fits estimated to
// true poses best, since the world frame of an alignment is free. `points_in_scanner[i]` are points
// of scan i at which the error is felt.
std::vector<PoseError> pose_errors(std::span<const Pose> estimated, std::span<const Pose> truth,
                                   std::span<const std::vector<Eigen::Vector3d>> points_in_scanner);

// The gauge motion that pose_errors removes: true_from_estimated_world. Both throw scan::Error:
// (input) for lists of different lengths, a scan without points or a pose that is not finite;
// (computation) if all points lie on one line. Of a single scan the gauge takes up the whole error.
Pose gauge(std::span<const Pose> estimated, std::span<const Pose> truth,
           std::span<const std::vector<Eigen::Vector3d>> points_in_scanner);

// Of the motion between each two neighbouring scans of the list, which needs no world frame: how
// far next_from_this is off. `translation_m` is felt at the centroid of the earlier scan's points.
// Empty for a single scan. Throws as pose_errors does.
std::vector<PoseError> relative_pose_errors(
    std::span<const Pose> estimated, std::span<const Pose> truth,
    std::span<const std::vector<Eigen::Vector3d>> points_in_scanner);

// relative_rotation_error, relative_translation_error (largest over pairs of neighbouring scans)
// and their means; nothing for no errors.
std::vector<Measurement> summarise_relative(const std::vector<PoseError>& errors);

// target_registration_error: how far each scan's pose carries the targets from their true places,
// root mean square over the targets, largest over the scans; target_registration_error_max, of the
// farthest target (Fitzpatrick et al. 1998). The world frame is fitted as in pose_errors, so
// targets count that no scan saw. Throws as pose_errors does, and scan::Error (input) for no
// target.
std::vector<Measurement> target_registration_error(
    std::span<const Pose> estimated, std::span<const Pose> truth,
    std::span<const std::vector<Eigen::Vector3d>> points_in_scanner,
    std::span<const Eigen::Vector3d> targets_in_world);

// rotation_error, translation_error, pose_error_rms (largest over scans) and their means over
// scans, rotation_error_mean, translation_error_mean, pose_error_rms_mean.
std::vector<Measurement> summarise(const std::vector<PoseError>& errors);

}  // namespace scan
