// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/block_factors.h"

#include <algorithm>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

using BlockMatrix = Eigen::Matrix<double, block_size, block_size>;

constexpr std::size_t blocks_per_task = 4;
constexpr std::int32_t shared = 0;

BlockMatrix bending_matrix(const BlockLevel& level, const BendingStencil& bending,
                           std::size_t block) {
  BlockMatrix matrix = BlockMatrix::Zero();
  for (std::size_t slot = 0; slot < block_size; ++slot) {
    bending.for_row(level, block * block_size + slot, [&](std::size_t function, double entry) {
      if (function / block_size == block)
        matrix(static_cast<Eigen::Index>(function % block_size), static_cast<Eigen::Index>(slot)) +=
            entry;
    });
    double& diagonal = matrix(static_cast<Eigen::Index>(slot), static_cast<Eigen::Index>(slot));
    if (diagonal == 0) diagonal = 1;  // outside the cube
  }
  return matrix;
}

// Calls visit(cell's matrix, functions, slots, count) for each cell with samples of block `from`
// and those of its functions that lie in the block at +(dx, dy, dz).
template <class Visit>
void for_cells(const CellMatrices& term, std::int32_t from, int dx, int dy, int dz, Visit&& visit) {
  const auto block = static_cast<std::uint32_t>(from);
  auto cell = std::lower_bound(term.cells.begin(), term.cells.end(), block * block_size);
  for (; cell != term.cells.end() && *cell / block_size == block; ++cell) {
    const int slot = static_cast<int>(*cell % block_size);
    int count = 0, functions[27], slots[27];
    for (int i = 0; i < 27; ++i) {
      const int x = slot % 4 + i % 3 - 4 * dx, y = slot / 4 % 4 + i / 3 % 3 - 4 * dy,
                z = slot / 16 + i / 9 - 4 * dz;
      if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= block_width) continue;
      functions[count] = i;
      slots[count++] = slot_in_block(x, y, z);
    }
    if (count > 0)
      visit(term.matrices[static_cast<std::size_t>(cell - term.cells.begin())], functions, slots,
            count);
  }
}

template <class Visit>
void for_cells_around(const BlockLevel& level, const CellMatrices& term, std::size_t block,
                      Visit&& visit) {
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
    const std::int32_t from = level.neighbours[block][neighbour_slot(-dx, -dy, -dz)];
    if (from >= 0) for_cells(term, from, dx, dy, dz, visit);
  }
}

bool has_samples(const BlockLevel& level, const CellMatrices& term, std::size_t block) {
  bool found = false;
  for_cells_around(level, term, block, [&](auto&&...) { found = true; });
  return found;
}

// Lower half.
void add_samples(const BlockLevel& level, const CellMatrices& term, std::size_t block,
                 BlockMatrix& matrix) {
  for_cells_around(level, term, block,
                   [&](const CellMatrix& from, const int* functions, const int* slots, int count) {
                     for (int j = 0; j < count; ++j)
                       for (int i = j; i < count; ++i)
                         matrix(slots[i], slots[j]) += entry(from, functions[i], functions[j]);
                   });
}

}  // namespace

BlockFactors::BlockFactors(const BlockLevel& level, const BendingStencil& bending,
                           const CellMatrices& term)
    : factor_of_(level.active, shared) {
  std::vector<char> is_own(level.active);
  parallel_for(level.active, [&](std::size_t b) {
    is_own[b] = !level.is_inner(b) || has_samples(level, term, b);
  });
  std::vector<std::size_t> block_of(1, level.active);
  BlockMatrix of_inner = BlockMatrix::Identity();
  for (std::size_t b = 0; b < level.active; ++b) {
    if (level.is_inner(b) && block_of.front() == level.active) {
      block_of.front() = b;
      of_inner = bending_matrix(level, bending, b);
    }
    if (!is_own[b]) continue;
    factor_of_[b] = static_cast<std::int32_t>(block_of.size());
    block_of.push_back(b);
  }
  factors_.resize(block_of.size());
  parallel_for(
      block_of.size(),
      [&](std::size_t k) {
        const std::size_t b = block_of[k];
        BlockMatrix matrix = of_inner;
        if (k != shared) {
          if (!level.is_inner(b)) matrix = bending_matrix(level, bending, b);
          add_samples(level, term, b, matrix);
        }
        factors_[k] = packed_cholesky<block_size>(matrix);
      },
      blocks_per_task);
}

template <class Real>
void BlockFactors::solve(std::size_t block, const Real* r, Real* z) const {
  using Values = Eigen::Matrix<Real, block_size, 1>;
  Eigen::Matrix<float, block_size, 1> x = Eigen::Map<const Values>(r).template cast<float>();
  solve_packed<block_size>(factors_[static_cast<std::size_t>(factor_of_[block])], x);
  Eigen::Map<Values>(z, block_size) = x.template cast<Real>();
}

template void BlockFactors::solve(std::size_t, const float*, float*) const;
template void BlockFactors::solve(std::size_t, const double*, double*) const;

}  // namespace scan
