// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/octree_grid.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "libscan/core/parallel.h"
#include "libscan/core/point_cloud.h"

namespace scan {
namespace {

constexpr int bits_per_axis = 21;

std::uint64_t key_of(const BlockPlace& place) {
  return (static_cast<std::uint64_t>(place[2]) << (2 * bits_per_axis)) |
         (static_cast<std::uint64_t>(place[1]) << bits_per_axis) |
         static_cast<std::uint64_t>(place[0]);
}

BlockPlace place_of(std::uint64_t key) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << bits_per_axis) - 1;
  return {static_cast<std::int32_t>(key & mask),
          static_cast<std::int32_t>((key >> bits_per_axis) & mask),
          static_cast<std::int32_t>(key >> (2 * bits_per_axis))};
}

int blocks_per_axis(int depth) {
  return ((1 << depth) + 1) / block_width + 1;
}

void sort_unique(std::vector<std::uint64_t>& keys) {
  parallel_sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

// Adds the keys of all blocks from `low` to `high` (inclusive) that lie on the level.
void add_range(BlockPlace low, BlockPlace high, int depth, std::vector<std::uint64_t>& keys) {
  const int last = blocks_per_axis(depth) - 1;
  for (int a = 0; a < 3; ++a) {
    low[a] = std::max(low[a], 0);
    high[a] = std::min(high[a], last);
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) keys.push_back(key_of({x, y, z}));
}

std::vector<std::uint64_t> keys_around_points(std::span<const Eigen::Vector3d> points,
                                              std::span<const int> depths, int depth) {
  // The functions cell - 1 ... cell + 3 lie in two blocks along each axis. Many points share them.
  std::vector<std::uint64_t> upper, keys;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (depths[p] < depth) continue;
    BlockPlace place;
    for (int a = 0; a < 3; ++a) place[a] = (cell_of(points[p][a], 1 << depth) + 3) / block_width;
    const std::uint64_t key = key_of(place);
    if (upper.empty() || key != upper.back()) upper.push_back(key);
  }
  sort_unique(upper);
  for (const std::uint64_t key : upper) {
    const BlockPlace p = place_of(key);
    add_range({p[0] - 1, p[1] - 1, p[2] - 1}, p, depth, keys);
  }
  sort_unique(keys);
  return keys;
}

void add_parents(const std::vector<std::uint64_t>& finer, std::vector<std::uint64_t>& keys) {
  for (const std::uint64_t key : finer) {
    const BlockPlace place = place_of(key);
    keys.push_back(key_of({place[0] / 2, place[1] / 2, place[2] / 2}));
  }
  sort_unique(keys);
}

BlockLevel make_level(int depth, const std::vector<std::uint64_t>& active) {
  std::vector<std::uint64_t> around;
  for (const std::uint64_t key : active) {
    const BlockPlace p = place_of(key);
    add_range({p[0] - 1, p[1] - 1, p[2] - 1}, {p[0] + 1, p[1] + 1, p[2] + 1}, depth, around);
  }
  sort_unique(around);
  BlockLevel level;
  level.depth = depth;
  level.active = active.size();
  level.keys = active;
  std::set_difference(around.begin(), around.end(), active.begin(), active.end(),
                      std::back_inserter(level.keys));
  for (const std::uint64_t key : level.keys) level.blocks.push_back(place_of(key));
  return level;
}

// Calls take(level) from the finest to the coarsest, not yet connected, until it returns false.
template <class Take>
void for_levels(std::span<const Eigen::Vector3d> points, std::span<const int> depths,
                int complete_depth, Take&& take) {
  const int finest = std::max(complete_depth, *std::max_element(depths.begin(), depths.end()));
  std::vector<std::uint64_t> finer;
  for (int depth = finest; depth >= coarsest_depth; --depth) {
    std::vector<std::uint64_t> active;
    if (depth > complete_depth) {
      active = keys_around_points(points, depths, depth);
      add_parents(finer, active);
    } else {
      const int last = blocks_per_axis(depth) - 1;
      add_range({0, 0, 0}, {last, last, last}, depth, active);
      sort_unique(active);
    }
    if (!take(make_level(depth, active))) return;
    finer = std::move(active);
  }
}

// The blocks of `level` at `centre` + (-1,-1,-1) ... (1,1,1).
std::array<std::int32_t, 27> find_around(const BlockLevel& level, const BlockPlace& centre) {
  std::array<std::int32_t, 27> found;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        found[neighbour_slot(dx, dy, dz)] =
            level.find({centre[0] + dx, centre[1] + dy, centre[2] + dz});
  return found;
}

void connect(OctreeGrid& grid) {
  for (std::size_t l = 0; l < grid.levels.size(); ++l) {
    BlockLevel& level = grid.levels[l];
    const std::size_t count = level.blocks.size();
    const bool has_finer = l + 1 < grid.levels.size();
    level.neighbours.resize(count);
    level.parent.assign(count, -1);
    level.children.resize(has_finer ? count : 0);
    parallel_for(count, [&](std::size_t b) {
      const BlockPlace& p = level.blocks[b];
      level.neighbours[b] = find_around(level, p);
      if (l > 0) level.parent[b] = grid.levels[l - 1].find({p[0] / 2, p[1] / 2, p[2] / 2});
      if (has_finer)
        level.children[b] = find_around(grid.levels[l + 1], {2 * p[0], 2 * p[1], 2 * p[2]});
    });
  }
}

// Bounds of the coordinates along each axis without the outermost 0.1 %.
Bounds percentile_box(std::span<const Eigen::Vector3d> points) {
  const std::size_t count = points.size();
  const std::size_t passed_over = std::min(std::max<std::size_t>(1, count / 1000), (count - 1) / 2);
  Bounds box;
  std::vector<double> sorted(count);
  Eigen::Vector3d low, high;
  for (int a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < count; ++i) sorted[i] = points[i][a];
    std::sort(sorted.begin(), sorted.end());
    low[a] = sorted[passed_over];
    high[a] = sorted[count - 1 - passed_over];
  }
  return Bounds(low, high);
}

}  // namespace

int cell_of(double u, int cells) {
  return std::clamp(static_cast<int>(std::floor(u * cells)), 0, cells - 1);
}

UnitBox robust_box(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) return {};
  Bounds box = percentile_box(points);
  const double grow = 0.5 * box.sizes().maxCoeff();
  box.extend(box.max() + Eigen::Vector3d::Constant(grow));
  box.extend(box.min() - Eigen::Vector3d::Constant(grow));
  Bounds kept;
  for (const auto& x : points)
    if (box.contains(x)) kept.extend(x);
  const double extent = kept.sizes().maxCoeff();
  const double rounding = 1e-12 * kept.max().cwiseAbs().cwiseMax(kept.min().cwiseAbs()).maxCoeff();
  if (!(extent > rounding)) return {};
  UnitBox unit;
  unit.side_m = 1.25 * extent;
  unit.origin_m = kept.center() - Eigen::Vector3d::Constant(unit.side_m / 2);
  return unit;
}

std::int32_t BlockLevel::find_active(const BlockPlace& place) const {
  if (place[0] < 0 || place[1] < 0 || place[2] < 0) return -1;
  const std::uint64_t key = key_of(place);
  const auto end = keys.begin() + static_cast<std::ptrdiff_t>(active);
  const auto at = std::lower_bound(keys.begin(), end, key);
  return at != end && *at == key ? static_cast<std::int32_t>(at - keys.begin()) : -1;
}

bool BlockLevel::any_active(const BlockPlace& low, int count) const {
  const auto block = [&](int axis, int end) {
    return (low[axis] + end * (count - 1)) / block_width;
  };
  for (int z = block(2, 0); z <= block(2, 1); ++z)
    for (int y = block(1, 0); y <= block(1, 1); ++y)
      for (int x = block(0, 0); x <= block(0, 1); ++x)
        if (find_active({x, y, z}) >= 0) return true;
  return false;
}

bool BlockLevel::is_inner(std::size_t block) const {
  const auto [low, high] = std::minmax_element(blocks[block].begin(), blocks[block].end());
  return *low >= 1 && block_width * (*high + 1) <= cells();
}

std::int32_t BlockLevel::find(const BlockPlace& place) const {
  if (place[0] < 0 || place[1] < 0 || place[2] < 0) return -1;
  if (const std::int32_t found = find_active(place); found >= 0) return found;
  const std::uint64_t key = key_of(place);
  const auto begin = keys.begin() + static_cast<std::ptrdiff_t>(active);
  const auto at = std::lower_bound(begin, keys.end(), key);
  return at != keys.end() && *at == key ? static_cast<std::int32_t>(at - keys.begin()) : -1;
}

std::vector<int> depths_seen(const OctreeGrid& grid, std::span<const Eigen::Vector3d> points) {
  std::vector<int> depths(points.size());
  parallel_for(points.size(), [&](std::size_t i) {
    depths[i] = coarsest_depth;
    for (std::size_t l = 1; l < grid.levels.size(); ++l) {
      const int cells = grid.levels[l].cells();
      const Eigen::Vector3d& u = points[i];
      // A cell of this name has the functions cell ... cell+2 on each axis.
      if (!grid.levels[l].any_active(
              {cell_of(u[0], cells), cell_of(u[1], cells), cell_of(u[2], cells)}, 3))
        break;
      depths[i] = grid.levels[l].depth;
    }
  });
  return depths;
}

OctreeGrid make_octree_grid(std::span<const Eigen::Vector3d> points, std::span<const int> depths,
                            int complete_depth) {
  OctreeGrid grid;
  for_levels(points, depths, complete_depth, [&](BlockLevel&& level) {
    grid.levels.insert(grid.levels.begin(), std::move(level));
    return true;
  });
  connect(grid);
  return grid;
}

bool reaches(const BlockPlace& block, int depth, const Eigen::AlignedBox3d& box) {
  const double width = std::ldexp(1.0, -depth);
  const Eigen::Vector3d first = block_width * Eigen::Vector3d(block[0], block[1], block[2]);
  // Functions live on the two cells before as well; one more for cells on the border.
  return Eigen::AlignedBox3d(width * (first - Eigen::Vector3d::Constant(3)),
                             width * (first + Eigen::Vector3d::Constant(block_width + 1)))
      .intersects(box);
}

BlockCount octree_blocks(std::span<const Eigen::Vector3d> points, std::span<const int> depths,
                         int complete_depth, const Eigen::AlignedBox3d& box, double enough) {
  BlockCount count;
  for_levels(points, depths, complete_depth, [&](BlockLevel&& level) {
    count.all += level.blocks.size();
    for (std::size_t b = 0; b < level.active; ++b)
      count.reaching += reaches(level.blocks[b], level.depth, box);
    return static_cast<double>(count.all) <= enough;
  });
  return count;
}

}  // namespace scan
