// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The local frame of surfaces and lobes.
#pragma once

#include <Eigen/Geometry>

namespace scan::synth {

// Columns x, y, z of a right-handed frame whose z axis is the unit vector; x and y as they come,
// since nothing here depends on the direction along a surface.
inline Eigen::Matrix3d frame_about(const Eigen::Vector3d& z) {
  Eigen::Matrix3d frame;
  frame.col(2) = z;
  frame.col(0) = z.unitOrthogonal();
  frame.col(1) = z.cross(frame.col(0));
  return frame;
}

}  // namespace scan::synth
