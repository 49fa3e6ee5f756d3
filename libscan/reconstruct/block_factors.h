// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The equations of each block of a level for its own functions, factorised.
#pragma once

#include "libscan/reconstruct/cell_matrices.h"
#include "libscan/reconstruct/packed_cholesky.h"

namespace scan {

// Functions that vanish at the samples have little energy though each function they are made of has
// much: a diagonal does not tell them from others, the matrix of a block does.
class BlockFactors {
 public:
  BlockFactors() = default;
  // Of the active blocks. `term`: the samples of this level and of all finer ones.
  BlockFactors(const BlockLevel& level, const BendingStencil& bending, const CellMatrices& term);
  // z = (matrix of the block)^-1 r, to the precision of float.
  template <class Real>
  void solve(std::size_t block, const Real* r, Real* z) const;

 private:
  std::vector<std::int32_t> factor_of_;  // inner blocks without samples share one
  std::vector<PackedCholesky<block_size>> factors_;
};

}  // namespace scan
