// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A density that varies in space, and the walk of a ray over its blocks, each with an upper bound.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace scan::synth {

// Density between 0 and 1 on a grid of cells over a box in world coordinates, trilinear between
// cell centres (level between the outermost centres and the box), 0 outside the box; x fastest.
struct DensityGrid {
  Eigen::AlignedBox3d box_m;
  Eigen::Vector3i cells = Eigen::Vector3i::Ones();
  std::vector<float> density;
  // Largest density in each block of 8^3 cells, by set_majorants(); empty: 1 everywhere, which is
  // right but slow where the density is small.
  std::vector<float> majorants;
};

void check(const DensityGrid& grid, const std::string& place);  // throws scan::Error (input)

void set_majorants(DensityGrid& grid);

double density_at(const DensityGrid& grid, const Eigen::Vector3d& x_m);

// The blocks along a ray in their order (Amanatides and Woo 1987), from the ray's origin to `end_m`
// (may be infinite): nothing outside the box.
class BlockWalk {
 public:
  struct Segment {
    double begin_m = 0;
    double end_m = 0;
    double majorant = 1;
  };

  BlockWalk(const DensityGrid& grid, const Eigen::Vector3d& origin,
            const Eigen::Vector3d& direction, double end_m);
  std::optional<Segment> next();

 private:
  void find_exit(int axis);

  const DensityGrid& grid_;
  Eigen::Vector3d origin_;
  Eigen::Vector3d direction_;
  Eigen::Vector3i blocks_;
  Eigen::Vector3d block_m_;
  Eigen::Vector3i block_ = Eigen::Vector3i::Zero();
  Eigen::Vector3d exit_m_;  // where the ray leaves the block's slab of each axis
  double at_m_ = 0;
  double end_m_ = 0;
};

}  // namespace scan::synth
