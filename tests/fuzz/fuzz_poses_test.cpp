// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Broken copies of pose files.
#include <gtest/gtest.h>

#include "libscan/io/poses.h"
#include "tests/fuzz/fuzz.h"

namespace scan::test {
namespace {

void read_sound_poses(const std::filesystem::path& path) {
  for (const NamedPose& named : read_poses(path)) {
    expect_finite("a pose", named.pose.matrix());
    const Eigen::Matrix3d turn = named.pose.linear();
    if ((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm() > 1e-9)
      throw std::logic_error("a pose is no rigid motion");
  }
}

TEST(Fuzz, Poses) {
  const TemporaryFolder folder;
  std::vector<NamedPose> poses;
  for (int i = 0; i < 4; ++i)
    poses.push_back({std::to_string(i), exp((Vector6() << 0.1 * i, 0.2, 0, 1, 2, 3).finished())});
  write_poses_tum(folder / "a.tum", poses);
  write_poses_kitti(folder / "a.kitti", poses);
  write_matrix(folder / "a.txt", poses[2].pose);
  write_file(folder / "a.conf",
             "camera 0 0 0 0 0 0 1\nbmesh bun000.ply 0 0 0 0 0 0 1\n"
             "bmesh bun045.ply -0.05 0.001 0.002 -0.6 0 0 0.8\n");
  write_file(folder / "a.log", "0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  write_file(folder / "alignment.json",
             R"({"scans": [{"file": "000.ply", "world_from_scan":
                [[1, 0, 0, 0.5], [0, 1, 0, 0.25], [0, 0, 1, 2], [0, 0, 0, 1]]}]})");
  for (const char* name : {"a.tum", "a.kitti", "a.txt", "a.conf", "a.log", "alignment.json"})
    fuzz(folder / name, read_sound_poses);
}

}  // namespace
}  // namespace scan::test
