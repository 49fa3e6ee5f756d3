// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How many rays pass by each corner of a grid and which way, near given places only.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace scan {

// Sums of directions on the corners of 2^depth cells of the unit cube, in bricks of 8 x 8 x 8
// corners around the places; whole numbers, so that the order of counting does not matter.
class RayBricks {
 public:
  RayBricks(std::span<const Eigen::Vector3d> places, int depth);
  // Counts at the corner nearest to each step of one cell along the segment. From any thread.
  void count(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  // Rays through one cell's area across `normal`, those that come from its side less the others;
  // the mean of the 27 nearest corners, since a single one sees few.
  double rays_through(const Eigen::Vector3d& u, const Eigen::Vector3d& normal) const;
  double cell_area() const { return 1 / (cells_ * cells_); }

 private:
  static constexpr int width = 8;
  static constexpr double unit = 256;                    // of a direction's length
  std::int64_t slot_of(const Eigen::Vector3d& u) const;  // -1: in no brick

  double cells_;
  std::vector<std::uint64_t> keys_;                    // of the bricks, sorted
  std::unique_ptr<std::atomic<std::int32_t>[]> sums_;  // x, y, z of each corner, in 1 / unit
};

}  // namespace scan
