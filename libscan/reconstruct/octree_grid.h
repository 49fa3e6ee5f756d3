// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// An adaptive octree as nested levels of blocks of B-spline functions.
//
// A level of depth d divides the unit cube into 2^d cells a side; along each axis it has the
// functions 0 ... 2^d+1 (bspline.h). Functions are kept in blocks of 4 x 4 x 4. A block is active
// (its functions are unknowns) or halo (an active block's neighbour, where sums of coarser levels
// are needed). The coarsest levels are complete.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scan {

// The cube that is scaled to the unit cube.
struct UnitBox {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double side_m = 0;
  Eigen::Vector3d to_unit(const Eigen::Vector3d& x) const { return (x - origin_m) / side_m; }
  Eigen::Vector3d to_world(const Eigen::Vector3d& u) const { return origin_m + side_m * u; }
};

// A cube 1.25 times as wide as the points that lie within the box of the 0.1 % and 99.9 %
// percentiles (at least the outermost point of each side is passed over) grown on all sides by half
// its longest edge; so a far outlier does not decide it. Points must be finite; side 0 if all are
// equal to rounding.
UnitBox robust_box(std::span<const Eigen::Vector3d> points);

inline constexpr int block_width = 4;
inline constexpr int block_size = block_width * block_width * block_width;
using BlockPlace = std::array<std::int32_t, 3>;  // functions 4*place ... 4*place+3 per axis

// Slot of a function in its block; x runs fastest.
inline int slot_in_block(int x, int y, int z) {
  return x + block_width * (y + block_width * z);
}

struct BlockLevel {
  int depth = 0;
  std::size_t active = 0;          // the first blocks are active, the others halo
  std::vector<BlockPlace> blocks;  // active ones in order of their keys, then halo ones likewise
  std::vector<std::uint64_t> keys;
  // Blocks at offset (-1,-1,-1) ... (1,1,1), x fastest; -1: none.
  std::vector<std::array<std::int32_t, 27>> neighbours;
  // The block of the coarser level at place/2; -1: none.
  std::vector<std::int32_t> parent;
  // Blocks of the finer level at 2*place + (-1,-1,-1) ... (1,1,1); -1: none.
  std::vector<std::array<std::int32_t, 27>> children;

  int cells() const { return 1 << depth; }
  std::int32_t find(const BlockPlace& place) const;         // -1: none
  std::int32_t find_active(const BlockPlace& place) const;  // -1: none or halo
  // Whether any of the functions `low` ... `low + count - 1` (per axis, count <= 5) is active.
  bool any_active(const BlockPlace& low, int count) const;
  // Whether the integrals of the block's functions are not cut by the cube's walls.
  bool is_inner(std::size_t block) const;
};

inline constexpr int coarsest_depth = 3;

struct OctreeGrid {
  std::vector<BlockLevel> levels;  // of depth coarsest_depth ... to the finest
  int finest_depth() const { return levels.back().depth; }
};

// Each point (in the unit cube) activates, on all levels to its own depth, the functions of its
// cell and of a ring of one cell around it; levels to `complete_depth` are active as a whole.
OctreeGrid make_octree_grid(std::span<const Eigen::Vector3d> points, std::span<const int> depths,
                            int complete_depth);

// Whether cells in the box, or at its border, need functions of the block.
bool reaches(const BlockPlace& block, int depth, const Eigen::AlignedBox3d& box);

// How many blocks, active and halo, such a grid has, and how many active ones reach the box;
// counting stops when all are above `enough`.
struct BlockCount {
  std::size_t all = 0, reaching = 0;
};
BlockCount octree_blocks(std::span<const Eigen::Vector3d> points, std::span<const int> depths,
                         int complete_depth, const Eigen::AlignedBox3d& box, double enough);

// The finest depth at which any active function reaches each point: there a sample sees all of f.
std::vector<int> depths_seen(const OctreeGrid& grid, std::span<const Eigen::Vector3d> points);

// Blocks of the neighbour tables by offsets in {-1, 0, 1}.
inline int neighbour_slot(int dx, int dy, int dz) {
  return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1);
}

// The cell of a coordinate in [0, 1] among `cells`.
int cell_of(double u, int cells);

}  // namespace scan
