// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Trajectories and pose files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libscan/core/pose.h"

namespace scan {

struct NamedPose {
  std::string name;  // of the scan, or the time stamp, or the line's number
  Pose pose = Pose::Identity();
};

// By content and ending: TUM (t tx ty tz qx qy qz qw), KITTI (12 numbers a line), one or more 4x4
// matrices (.txt, .xf), Stanford .conf (`bmesh FILE tx ty tz qx qy qz qw`, whose quaternion is the
// inverse rotation: x_world = R(q)^T x + t; `camera` lines are no scans), or alignment.json as
// written by align. Redwood's .log (three whole numbers before each matrix) is read as well; #
// begins a comment. Matrices an entry of which is more than 1e-6 off a rotation, left-handed ones
// and quaternions whose length is not 1 within 5e-4 are refused, nearer ones projected, and those
// within 1e-12 kept to the bit. scan::Error (input) names file, line and word.
std::vector<NamedPose> read_poses(const std::filesystem::path& path);

// The pose of a 4x4 matrix, with the same rule for its rotation; `place` is how errors call it.
Pose pose_from_matrix(const Eigen::Matrix4d& matrix, const std::string& place);

// TUM, with the index as time stamp unless a name is a number; 17 digits.
void write_poses_tum(const std::filesystem::path& path, const std::vector<NamedPose>& poses);
void write_poses_kitti(const std::filesystem::path& path, const std::vector<NamedPose>& poses);
void write_matrix(const std::filesystem::path& path, const Pose& pose);  // 4x4, 17 digits

}  // namespace scan
