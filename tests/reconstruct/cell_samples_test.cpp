// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cell_samples.h"

#include <gtest/gtest.h>

#include <numeric>

#include "libscan/core/random.h"

namespace scan {
namespace {

// First and last cell of each of four blocks, one of them without samples.
TEST(CellSamples, OfABlockAreThoseOfItsFirstToItsLastCell) {
  const std::vector<CellSample> placed = {{0, 7}, {63, 1}, {64, 4}, {127, 2}, {127, 3}, {192, 5}};
  const std::vector<std::size_t> counts = {2, 3, 0, 1};
  std::size_t before = 0;
  for (std::size_t block = 0; block < counts.size(); ++block) {
    const auto found = of_block(placed, block);
    EXPECT_EQ(found.size(), counts[block]) << block;
    if (!found.empty()) {
      EXPECT_EQ(found.data(), placed.data() + before) << block;
    }
    before += counts[block];
  }
}

// Every sample stands once, in the cell of 16 a side that it lies in, and in order.
TEST(CellSamples, LieInTheCellsThatAreNamed) {
  Samples samples;
  for (std::uint64_t i = 0; i < 500; ++i) {
    RandomStream random(1, 0, i);
    samples.points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  }
  const std::vector<int> depths(samples.points.size(), 4);
  const OctreeGrid grid = make_octree_grid(samples.points, depths, 4);
  const BlockLevel& level = grid.levels.back();
  ASSERT_EQ(level.cells(), 16);
  std::vector<std::uint32_t> chosen(samples.points.size());
  std::iota(chosen.rbegin(), chosen.rend(), 0u);
  const std::vector<CellSample> placed = in_cells(level, samples, chosen);
  ASSERT_EQ(placed.size(), chosen.size());
  std::vector<int> seen(placed.size(), 0);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const auto [cell, sample] = placed[i];
    const BlockPlace& block = level.blocks[cell / block_size];
    const int slot = static_cast<int>(cell % block_size);
    const Eigen::Vector3d& u = samples.points[sample];
    const Eigen::Vector3i at(4 * block[0] + slot % 4, 4 * block[1] + slot / 4 % 4,
                             4 * block[2] + slot / 16);
    EXPECT_EQ(at, (16 * u).array().floor().matrix().cast<int>());
    if (i > 0) {
      EXPECT_TRUE(std::pair(placed[i - 1].cell, placed[i - 1].sample) < std::pair(cell, sample));
    }
    ++seen[sample];
  }
  EXPECT_EQ(seen, std::vector<int>(placed.size(), 1));
}

}  // namespace
}  // namespace scan
