// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The equations of each 2 x 2 x 2 functions of a level for themselves, factorised.
#pragma once

#include "libscan/reconstruct/cell_samples.h"
#include "libscan/reconstruct/packed_cholesky.h"
#include "libscan/reconstruct/sample_term.h"

namespace scan {

// Between a diagonal and block_factors.h, for levels of many blocks: with 1/7 of the numbers of
// whole blocks, and no matrices of cells to be kept while they are made.
class OctetFactors {
 public:
  OctetFactors() = default;
  // Of the active blocks. `placed`: samples of this level and of all finer ones, from in_cells().
  OctetFactors(const BlockLevel& level, const BendingStencil& bending, const Samples& samples,
               const SampleWeights& weights, std::span<const CellSample> placed);
  // z = (matrices of the block's octets)^-1 r, to the precision of float.
  template <class Real>
  void solve(std::size_t block, const Real* r, Real* z) const;

 private:
  std::vector<std::int32_t> factors_of_;  // inner blocks without samples share one
  std::vector<std::array<PackedCholesky<8>, 8>> factors_;
};

}  // namespace scan
