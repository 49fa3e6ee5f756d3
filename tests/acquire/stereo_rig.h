// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A stereo rig whose cameras differ, lean towards each other and stand a little askew.
#pragma once

#include "libscan/acquire/rectify.h"
#include "tests/acquire/board_pictures.h"

namespace scan::test {

inline StereoRig leaning_rig() {
  StereoRig rig{bent_camera(), bent_camera()};
  rig.right.fx_px = 890, rig.right.fy_px = 893, rig.right.cx_px = 405, rig.right.cy_px = 296;
  rig.right.k1 = -0.13, rig.right.p2 = 0.0004;
  const Eigen::Vector3d lean(0.01, 0.15, -0.02);
  const Eigen::Matrix3d turn = exp((Vector6() << lean, 0, 0, 0).finished()).linear();
  rig.right_from_left = make_pose(turn, -turn * Eigen::Vector3d(0.06, 0.002, -0.001));
  return rig;
}

// Boards that both cameras see as a whole; left camera's frame.
inline std::vector<Pose> boards_in_sight_of_both(const StereoRig& rig, std::uint64_t seed,
                                                 std::size_t count) {
  std::vector<Pose> poses;
  for (const Pose& pose : held_boards(rig.left, test_board, seed, 100)) {
    const std::vector<Eigen::Vector3d> corners = corners_m(test_board);
    const bool in_sight = std::all_of(corners.begin(), corners.end(), [&](const auto& corner) {
      const auto pixel = project(rig.right, rig.right_from_left * (pose * corner));
      return pixel && pixel->x() > 15 && pixel->x() < 784 && pixel->y() > 15 && pixel->y() < 584;
    });
    if (in_sight && poses.size() < count) poses.push_back(pose);
  }
  return poses;
}

// A wall whose brightness is three waves that do not repeat within a stereo search.
inline Image<std::uint8_t> wavy_wall(const Camera& camera, const Pose& camera_from_wall) {
  Image<std::uint8_t> picture(camera.width_px, camera.height_px);
  const Pose wall_from_camera = camera_from_wall.inverse();
  for (int row = 0; row < camera.height_px; ++row)
    for (int column = 0; column < camera.width_px; ++column) {
      const Eigen::Vector2d at = on_board(camera, wall_from_camera,
                                          {static_cast<double>(column), static_cast<double>(row)});
      const double level = 127 + 40 * std::sin(2100 * at.x() + 300 * at.y()) +
                           40 * std::sin(1370 * at.x() - 900 * at.y() + 1) +
                           40 * std::sin(910 * at.x() + 1500 * at.y() + 2);
      picture(column, row) = static_cast<std::uint8_t>(std::lround(level));
    }
  return picture;
}

}  // namespace scan::test
