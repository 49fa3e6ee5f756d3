// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cell_samples.h"

#include <algorithm>

#include "libscan/core/parallel.h"

namespace scan {

std::vector<CellSample> in_cells(const BlockLevel& level, const Samples& samples,
                                 std::span<const std::uint32_t> chosen) {
  // Whole numbers sort faster than pairs.
  std::vector<std::uint64_t> keys(chosen.size());
  parallel_for(
      chosen.size(),
      [&](std::size_t i) {
        const Eigen::Vector3d& u = samples.points[chosen[i]];
        const int cells = level.cells();
        const int x = cell_of(u[0], cells), y = cell_of(u[1], cells), z = cell_of(u[2], cells);
        const auto block = static_cast<std::uint64_t>(level.find({x / 4, y / 4, z / 4}));
        const auto slot = static_cast<std::uint64_t>(slot_in_block(x % 4, y % 4, z % 4));
        keys[i] = (block * block_size + slot) << 32 | chosen[i];
      },
      1024);
  parallel_sort(keys);
  std::vector<CellSample> placed(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    placed[i] = {static_cast<std::uint32_t>(keys[i] >> 32), static_cast<std::uint32_t>(keys[i])};
  return placed;
}

std::span<const CellSample> of_block(std::span<const CellSample> placed, std::size_t block) {
  const auto starts_at = [&](std::size_t cell) {
    return std::partition_point(placed.begin(), placed.end(),
                                [&](const CellSample& s) { return s.cell < cell; });
  };
  return {starts_at(block * block_size), starts_at((block + 1) * block_size)};
}

}  // namespace scan
