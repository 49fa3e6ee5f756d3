// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What every method's input goes through first: strays left out, normals there and agreeing.
#pragma once

#include <span>

#include "libscan/core/point_cloud.h"

namespace scan {

struct PreparedPoints {
  PointCloud cloud;
  std::vector<Eigen::Vector3d> viewpoints;  // of the points that are left; empty: unknown
  std::vector<double> spacing_m;            // about each point
  std::size_t invalid_points = 0;           // not finite, left out
  std::size_t outlying_points = 0;          // left out (outliers.h)
  std::size_t estimated_normals = 0;        // were missing and are plane fits now
  std::size_t turned_normals = 0;           // (orientation.h)
};

// `viewpoints`: where the scanner of each point stood, or empty; normals that have to be estimated
// face it. Throws scan::Error (input) for arrays of different length or fewer than 4 finite points.
PreparedPoints prepare_points(const PointCloud& cloud, std::span<const Eigen::Vector3d> viewpoints);

}  // namespace scan
