// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/density_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "libscan/core/error.h"

namespace scan::synth {
namespace {

constexpr int block_cells = 8;

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  message.precision(9);
  (message << ... << parts);
  throw Error(Trouble::input, message.str());
}

std::size_t index_of(const Eigen::Vector3i& counts, const Eigen::Vector3i& at) {
  return (static_cast<std::size_t>(at.z()) * counts.y() + at.y()) * counts.x() + at.x();
}

Eigen::Vector3i blocks_of(const DensityGrid& grid) {
  if (grid.majorants.empty()) return Eigen::Vector3i::Ones();
  return (grid.cells.array() + block_cells - 1) / block_cells;
}

// Calls body(cell) for each cell from `low` to `high`, both included.
template <class Body>
void for_each_cell(const Eigen::Vector3i& low, const Eigen::Vector3i& high, Body&& body) {
  Eigen::Vector3i cell;
  for (cell.z() = low.z(); cell.z() <= high.z(); ++cell.z())
    for (cell.y() = low.y(); cell.y() <= high.y(); ++cell.y())
      for (cell.x() = low.x(); cell.x() <= high.x(); ++cell.x()) body(cell);
}

}  // namespace

void check(const DensityGrid& grid, const std::string& place) {
  const Eigen::Vector3d size = grid.box_m.sizes();
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("[") + "xyz"[axis] + "]";
    if (!(std::isfinite(size[axis]) && size[axis] > 0 && std::isfinite(grid.box_m.min()[axis])))
      refuse(place, "/box_m", name, ": size ", size[axis], ", must be positive and finite");
    if (grid.cells[axis] < 1)
      refuse(place, "/cells", name, ": ", grid.cells[axis], ", must be at least 1");
  }
  const double count = grid.cells.cast<double>().prod();
  if (static_cast<double>(grid.density.size()) != count)
    refuse(place, "/density: ", grid.density.size(), " numbers, must be ", count,
           ", one for each cell");
  for (std::size_t i = 0; i < grid.density.size(); ++i)
    if (!(grid.density[i] >= 0 && grid.density[i] <= 1))
      refuse(place, "/density[", i, "]: ", grid.density[i], ", must be from 0 to 1");
}

// Inside a block the density is interpolated from its own cells and one more on each side.
void set_majorants(DensityGrid& grid) {
  grid.majorants.assign(1, 0);  // for blocks_of
  const Eigen::Vector3i blocks = blocks_of(grid);
  grid.majorants.assign(static_cast<std::size_t>(blocks.prod()), 0);
  for_each_cell(Eigen::Vector3i::Zero(), blocks.array() - 1, [&](const Eigen::Vector3i& block) {
    float& most = grid.majorants[index_of(blocks, block)];
    const Eigen::Vector3i low = (block * block_cells).array() - 1;
    const Eigen::Vector3i high = low.array() + block_cells + 1;
    for_each_cell(low.cwiseMax(0), high.cwiseMin((grid.cells.array() - 1).matrix()),
                  [&](const Eigen::Vector3i& cell) {
                    most = std::max(most, grid.density[index_of(grid.cells, cell)]);
                  });
  });
}

double density_at(const DensityGrid& grid, const Eigen::Vector3d& x_m) {
  if (!grid.box_m.contains(x_m)) return 0;
  const Eigen::Vector3d place = (x_m - grid.box_m.min())
                                    .cwiseQuotient(grid.box_m.sizes())
                                    .cwiseProduct(grid.cells.cast<double>())
                                    .array() -
                                0.5;
  const Eigen::Vector3d corner = place.array().floor();
  const Eigen::Vector3d share = place - corner;
  double density = 0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3i step(i & 1, i >> 1 & 1, i >> 2 & 1);
    const Eigen::Vector3i cell =
        (corner.cast<int>() + step).cwiseMax(0).cwiseMin((grid.cells.array() - 1).matrix());
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= step[axis] ? share[axis] : 1 - share[axis];
    density += weight * grid.density[index_of(grid.cells, cell)];
  }
  return density;
}

BlockWalk::BlockWalk(const DensityGrid& grid, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction, double end_m)
    : grid_(grid), origin_(origin), direction_(direction), blocks_(blocks_of(grid)), end_m_(end_m) {
  const Eigen::Vector3d cell_m = grid.box_m.sizes().cwiseQuotient(grid.cells.cast<double>());
  block_m_ = grid.majorants.empty() ? grid.box_m.sizes() : Eigen::Vector3d(block_cells * cell_m);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = grid.box_m.min()[axis], high = grid.box_m.max()[axis];
    if (direction[axis] == 0) {
      if (origin[axis] < low || origin[axis] > high) end_m_ = 0;
      continue;
    }
    const double to_low = (low - origin[axis]) / direction[axis];
    const double to_high = (high - origin[axis]) / direction[axis];
    at_m_ = std::max(at_m_, std::min(to_low, to_high));
    end_m_ = std::min(end_m_, std::max(to_low, to_high));
  }
  if (!(at_m_ < end_m_)) return;
  for (int axis = 0; axis < 3; ++axis) {
    const double inside = origin[axis] + at_m_ * direction[axis] - grid.box_m.min()[axis];
    block_[axis] =
        static_cast<int>(std::clamp(std::floor(inside / block_m_[axis]), 0.0, blocks_[axis] - 1.0));
    find_exit(axis);
  }
}

void BlockWalk::find_exit(int axis) {
  if (direction_[axis] == 0) {
    exit_m_[axis] = std::numeric_limits<double>::infinity();
    return;
  }
  const double face =
      grid_.box_m.min()[axis] + (block_[axis] + (direction_[axis] > 0 ? 1 : 0)) * block_m_[axis];
  exit_m_[axis] = (face - origin_[axis]) / direction_[axis];
}

std::optional<BlockWalk::Segment> BlockWalk::next() {
  if (!(at_m_ < end_m_)) return std::nullopt;
  int axis = 0;
  exit_m_.minCoeff(&axis);
  const double begin_m = at_m_;
  const double majorant = grid_.majorants.empty() ? 1 : grid_.majorants[index_of(blocks_, block_)];
  at_m_ = std::clamp(exit_m_[axis], begin_m, end_m_);
  const double segment_end_m = at_m_;
  block_[axis] += direction_[axis] > 0 ? 1 : -1;
  if (block_[axis] < 0 || block_[axis] >= blocks_[axis])
    at_m_ = end_m_;  // the box ends here
  else
    find_exit(axis);
  return Segment{begin_m, segment_end_m, majorant};
}

}  // namespace scan::synth
