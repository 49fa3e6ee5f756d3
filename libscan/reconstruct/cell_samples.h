// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples in the order of the cells of a level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libscan/reconstruct/octree_grid.h"
#include "libscan/reconstruct/samples.h"

namespace scan {

// Cells are named block_size * block + slot_in_block.
struct CellSample {
  std::uint32_t cell, sample;
};

// The chosen samples by (cell, sample).
std::vector<CellSample> in_cells(const BlockLevel& level, const Samples& samples,
                                 std::span<const std::uint32_t> chosen);

// Those in the cells of one block.
std::span<const CellSample> of_block(std::span<const CellSample> placed, std::size_t block);

}  // namespace scan
