// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One scan: what a device delivers from one place, and nothing that a device would not know.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libscan/core/point_cloud.h"

namespace scan {

// Rows times columns of rays; {0, 0} when the device has no grid.
struct RayGrid {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
};

// How far off a guess of a scanner's pose is: turned about some axis through the scanner, shifted
// in some direction, each as likely as any; root mean squares of angle and distance.
struct GuessSigma {
  double rotation_rad = 0, translation_m = 0;
};

struct Scan {
  std::string name;
  PointCloud cloud;                // scanner frame
  std::vector<std::uint32_t> ray;  // index of each point's ray; empty: unknown
  RayGrid grid;                    // ray = row * columns + column
  // Rays share noise with those around: that of two is correlated by (1 - rows apart / rows)
  // (1 - columns apart / columns) of these, as means over windows of so many pixels are.
  RayGrid noise_window{1, 1};                           // each ray has its own
  std::map<std::string, std::size_t> misses;            // reason -> rays without a point
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  // scanner frame: normals face this point
  Pose world_from_scanner_guess = Pose::Identity();
  std::optional<GuessSigma> guess_sigma;  // none: not known
};

}  // namespace scan
