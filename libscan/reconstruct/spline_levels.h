// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Functions that are sums of B-splines on all levels of an octree, and how levels act together.
//
// Splines are nested: a coarse function is a sum of finer ones (the refinement mask). So the sum u
// of a level's own coefficients and those of all coarser levels, written in that level's functions,
// is all that the level's integrals and samples need.
#pragma once

#include <tuple>
#include <vector>

#include "libscan/reconstruct/bending_kernel.h"
#include "libscan/reconstruct/bspline.h"
#include "libscan/reconstruct/octree_grid.h"

namespace scan {

// One array per level, block_size numbers per block: of all active blocks for unknowns, of all
// blocks for sums.
template <class Real>
using LevelArraysOf = std::vector<std::vector<Real>>;
using LevelArrays = LevelArraysOf<double>;

// Zeros of all active blocks. This and what follows is there for float and double.
template <class Real = double>
LevelArraysOf<Real> active_arrays(const OctreeGrid& grid);

// Writes P coarse over `fine` (all blocks of level `l`): the same function in finer splines.
template <class Real>
void prolong(const OctreeGrid& grid, std::size_t l, const std::vector<Real>& coarse,
             std::vector<Real>& fine);

// Adds P^T fine to `coarse` (all blocks of level `l`; `fine` of level l+1).
template <class Real>
void restrict_add(const OctreeGrid& grid, std::size_t l, const std::vector<Real>& fine,
                  std::vector<Real>& coarse);

// Copies the functions that act on a block's cells, 4*place ... 4*place+5 per axis, into a cube. A
// block that is missing, or that lies behind the end of `values`, counts as zero.
inline constexpr int block_cell_functions = block_width + 2;
template <class Real>
void gather_cell_functions(const BlockLevel& level, const std::vector<Real>& values,
                           std::size_t block, Real* cube);

// integral of |D^2 f|^2 as a matrix S of one level: sum += S values on a block. `values` may hold
// active blocks only.
class BendingStencil {
 public:
  explicit BendingStencil(int depth);
  template <class Real>
  void add(const BlockLevel& level, const std::vector<Real>& values, std::size_t block,
           Real* sum) const;
  double diagonal(const BlockPlace& place, int slot) const { return entry(place, slot, 2, 2, 2); }
  // Calls visit(function, entry) along the row of S of a function of an active block.
  template <class Visit>
  void for_row(const BlockLevel& level, std::size_t function, Visit&& visit) const;

 private:
  // Of a function and that at `tap` - 2 from it on each axis.
  double entry(const BlockPlace& place, int slot, int tap_x, int tap_y, int tap_z) const;

  double inverse_cell_;
  std::vector<StencilRow> rows_;
  // Of each block along an axis.
  std::tuple<std::vector<AxisStencil<float>>, std::vector<AxisStencil<double>>> axes_;
};

template <class Visit>
void BendingStencil::for_row(const BlockLevel& level, std::size_t function, Visit&& visit) const {
  const std::size_t block = function / block_size;
  const int slot = static_cast<int>(function % block_size);
  for (int tap = 0; tap < 125; ++tap) {
    // From the first function of the block before.
    const int x = slot % 4 + tap % 5 + 2, y = slot / 4 % 4 + tap / 5 % 5 + 2,
              z = slot / 16 + tap / 25 + 2;
    const std::int32_t owner =
        level.neighbours[block][neighbour_slot(x / 4 - 1, y / 4 - 1, z / 4 - 1)];
    if (owner >= 0)
      visit(static_cast<std::size_t>(owner) * block_size +
                static_cast<std::size_t>(slot_in_block(x % 4, y % 4, z % 4)),
            entry(level.blocks[block], slot, tap % 5, tap / 5 % 5, tap / 25));
  }
}

}  // namespace scan
