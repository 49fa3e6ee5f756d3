// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rotations spread evenly over all there are.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace scan {

// Super-Fibonacci spirals (Alexa, CVPR 2022): `count` unit quaternions; no rotation is farther than
// 4.3 rad / count^(1/3) from the nearest of them.
std::vector<Eigen::Quaterniond> rotation_grid(std::size_t count);

}  // namespace scan
