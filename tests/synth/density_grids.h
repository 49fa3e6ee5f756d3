// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A density grid for tests and the exact integral of its trilinear density along a line.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "libscan/core/random.h"
#include "synth/medium/density_grid.h"

namespace scan::synth {

// 21 x 10 x 17 cells that are no cubes; whole blocks of it are empty, others dense.
inline DensityGrid cloud_with_holes() {
  DensityGrid grid;
  grid.box_m = {Eigen::Vector3d(-1, 2, 0.5), Eigen::Vector3d(1.1, 3.5, 2)};
  grid.cells = {21, 10, 17};
  RandomStream random(7, 7, 7);
  for (int z = 0; z < 17; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 21; ++x) {
        const double value = random.uniform();
        const bool hole = (x > 6 && x < 17) || (z < 9 && x >= 17);
        grid.density.push_back(hole ? 0 : static_cast<float>(z < 8 ? 0.1 * value : value));
      }
  return grid;
}

struct Line {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

// From outside through the box, from within, along an axis, past the box.
inline std::vector<Line> lines_through_the_cloud() {
  return {{{-1.5, 1.9, 0.4}, {1.3, 3.4, 2.2}},
          {{0.9, 3.2, 1.9}, {-0.8, 2.3, 0.9}},
          {{-0.83, 2.61, 3}, {-0.83, 2.61, -3}},
          {{-2, 2.5, 1.4}, {2, 2.5, 1.4}},
          {{-2, 4, 1}, {2, 4, 1}}};
}

// By three nested linear interpolations, apart from the library's code.
inline double trilinear(const DensityGrid& grid, const Eigen::Vector3d& x) {
  if (!grid.box_m.contains(x)) return 0;
  Eigen::Vector3i low;
  Eigen::Vector3d share;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell_m = grid.box_m.sizes()[axis] / grid.cells[axis];
    const double place =
        std::clamp((x[axis] - grid.box_m.min()[axis]) / cell_m - 0.5, 0.0, grid.cells[axis] - 1.0);
    low[axis] = std::min(static_cast<int>(place), std::max(0, grid.cells[axis] - 2));
    share[axis] = place - low[axis];
  }
  const auto at = [&](int dx, int dy, int dz) {
    const auto index = [&](int axis, int d) {
      return std::min(low[axis] + d, grid.cells[axis] - 1);
    };
    return static_cast<double>(
        grid.density[(static_cast<std::size_t>(index(2, dz)) * grid.cells.y() + index(1, dy)) *
                         grid.cells.x() +
                     index(0, dx)]);
  };
  const auto along_x = [&](int dy, int dz) {
    return std::lerp(at(0, dy, dz), at(1, dy, dz), share.x());
  };
  const auto along_y = [&](int dz) { return std::lerp(along_x(0, dz), along_x(1, dz), share.y()); };
  return std::lerp(along_y(0), along_y(1), share.z());
}

// Between two planes through cell centres, or the box's faces, the density is a cubic along the
// line, which Gauss' rule with two points integrates exactly.
inline double line_integral(const DensityGrid& grid, const Eigen::Vector3d& from,
                            const Eigen::Vector3d& to) {
  std::vector<double> cuts = {0, 1};
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    if (way == 0) continue;
    const double cell_m = grid.box_m.sizes()[axis] / grid.cells[axis];
    for (int i = -1; i <= grid.cells[axis]; ++i) {
      const double plane = std::clamp(i + 0.5, 0.0, double(grid.cells[axis])) * cell_m;
      const double t = (grid.box_m.min()[axis] + plane - from[axis]) / way;
      if (t > 0 && t < 1) cuts.push_back(t);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double middle = (cuts[i] + cuts[i - 1]) / 2, half = (cuts[i] - cuts[i - 1]) / 2;
    for (const double side : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)})
      sum += half * trilinear(grid, from + (middle + side * half) * (to - from));
  }
  return sum * (to - from).norm();
}

}  // namespace scan::synth
