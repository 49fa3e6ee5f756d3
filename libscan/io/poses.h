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
// written by align. Rotations further than 1e-3 from SO(3) are refused, nearer ones projected.
std::vector<NamedPose> read_poses(const std::filesystem::path& path);

// TUM, with the index as time stamp unless a name is a number; 17 digits.
void write_poses_tum(const std::filesystem::path& path, const std::vector<NamedPose>& poses);
void write_poses_kitti(const std::filesystem::path& path, const std::vector<NamedPose>& poses);
void write_matrix(const std::filesystem::path& path, const Pose& pose);  // 4x4, 17 digits

}  // namespace scan
