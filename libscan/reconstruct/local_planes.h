// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The plane of least squares through the nearest points of each point.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace scan {

struct LocalPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit, of either sign; (0,0,0): none fits
  double thickness_m = 0;                            // rms distance of the neighbours to it
  double width_m = 0;   // root of the neighbours' second largest moment: their spread in the plane
  double offset_m = 0;  // of the point itself from the plane
  double reach_m = 0;   // distance of the farthest neighbour
};

struct LocalPlanes {
  std::size_t neighbours = 0;         // of each point, itself left out
  std::vector<std::uint32_t> around;  // point i: `neighbours` from i * neighbours, nearest first
  std::vector<LocalPlane> planes;
};

// Over min(neighbours, all others) points; points must be finite.
LocalPlanes local_planes(std::span<const Eigen::Vector3d> points, std::size_t neighbours);

// The same for `points`, those of `all` that are `kept` (ascending): only points that have lost a
// neighbour are fitted anew.
LocalPlanes remaining_planes(const LocalPlanes& all, std::span<const Eigen::Vector3d> points,
                             std::span<const std::uint32_t> kept);

}  // namespace scan
