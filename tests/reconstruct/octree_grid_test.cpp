// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/octree_grid.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

TEST(RobustBox, IsNotDecidedByAFarPoint) {
  std::vector<Eigen::Vector3d> points = sphere_cloud(5000).points;
  const UnitBox without = robust_box(points);
  points.push_back({1e6, -1e6, 3e5});
  const UnitBox with = robust_box(points);
  EXPECT_NEAR(with.side_m, without.side_m, 1e-12);
  EXPECT_NEAR((with.origin_m - without.origin_m).norm(), 0, 1e-12);
  EXPECT_NEAR(without.side_m, 2.5, 0.01);  // 1.25 diameters, to the gap of the outermost samples
}

TEST(RobustBox, HasNoSideForOnePlace) {
  EXPECT_EQ(robust_box(std::vector<Eigen::Vector3d>(20, {1e6, 2, 3})).side_m, 0);
}

OctreeGrid sphere_grid(int depth) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& x : sphere_cloud(2000).points)
    points.push_back(0.4 * x + Eigen::Vector3d::Constant(0.5));
  // Deep on one side only, so that level differences meet.
  std::vector<int> depths;
  for (const auto& u : points) depths.push_back(u[0] > 0.5 ? depth : 4);
  return make_octree_grid(points, depths, 4);
}

TEST(OctreeGrid, HoldsTheParentsOfItsActiveBlocks) {
  const OctreeGrid grid = sphere_grid(7);
  ASSERT_EQ(grid.finest_depth(), 7);
  for (std::size_t l = 1; l < grid.levels.size(); ++l)
    for (std::size_t b = 0; b < grid.levels[l].active; ++b) {
      const BlockPlace p = grid.levels[l].blocks[b];
      const std::int32_t parent = grid.levels[l - 1].find_active({p[0] / 2, p[1] / 2, p[2] / 2});
      ASSERT_GE(parent, 0);
      EXPECT_EQ(grid.levels[l].parent[b], parent);
    }
}

// One point to a grid: the functions of its cell and of the cells around it, and no block besides.
TEST(OctreeGrid, ActivatesWhatActsAroundAPoint) {
  for (const double u : {0.001, 0.502, 0.51, 0.52, 0.526, 0.53, 0.999}) {
    const std::vector<Eigen::Vector3d> point = {{u, 0.3, 1 - u}};
    const BlockLevel level = make_octree_grid(point, std::vector<int>{7}, 3).levels.back();
    BlockPlace low, high;
    for (int a = 0; a < 3; ++a) {
      const int cell = cell_of(point[0][a], 128);
      low[a] = std::max(cell - 1, 0) / block_width;
      high[a] = std::min(cell + 3, 129) / block_width;
    }
    std::size_t count = 1;
    for (int a = 0; a < 3; ++a) count *= static_cast<std::size_t>(high[a] - low[a] + 1);
    EXPECT_EQ(level.active, count);
    for (std::size_t b = 0; b < level.active; ++b)
      for (int a = 0; a < 3; ++a) {
        EXPECT_GE(level.blocks[b][a], low[a]);
        EXPECT_LE(level.blocks[b][a], high[a]);
      }
  }
}

TEST(OctreeGrid, SurroundsEachActiveBlock) {
  const OctreeGrid grid = sphere_grid(6);
  for (const BlockLevel& level : grid.levels)
    for (std::size_t b = 0; b < level.active; ++b)
      for (int slot = 0; slot < 27; ++slot) {
        BlockPlace p = level.blocks[b];
        p[0] += slot % 3 - 1;
        p[1] += slot / 3 % 3 - 1;
        p[2] += slot / 9 - 1;
        const int last = (level.cells() + 1) / block_width;
        const bool on_level =
            std::min({p[0], p[1], p[2]}) >= 0 && std::max({p[0], p[1], p[2]}) <= last;
        ASSERT_EQ(level.neighbours[b][slot] >= 0, on_level);
        if (on_level) {
          EXPECT_EQ(level.blocks[level.neighbours[b][slot]], p);
        }
      }
}

TEST(OctreeGrid, CountsItsBlocksWithoutBuildingIt) {
  const std::vector<Eigen::Vector3d> points = {{0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}};
  const std::vector<int> depths = {8, 6};
  std::size_t blocks = 0;
  for (const BlockLevel& level : make_octree_grid(points, depths, 4).levels)
    blocks += level.blocks.size();
  const Eigen::AlignedBox3d cube(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  EXPECT_EQ(octree_blocks(points, depths, 4, cube, 1e9).all, blocks);
  EXPECT_GT(octree_blocks(points, depths, 4, cube, 10).all, 10u);  // enough
  EXPECT_LT(octree_blocks(points, depths, 4, cube, 10).all, blocks);
}

// Cells of a level that meet the box, by name; cell i has the functions i ... i+2 on each axis.
bool is_needed(const BlockPlace& block, int depth, const Eigen::AlignedBox3d& box) {
  for (int a = 0; a < 3; ++a) {
    const int first_cell = cell_of(box.min()[a], 1 << depth);
    const int last_cell = cell_of(box.max()[a], 1 << depth);
    if (4 * block[a] > last_cell + 2 || 4 * block[a] + 3 < first_cell) return false;
  }
  return true;
}

TEST(OctreeGrid, CountsTheBlocksThatReachABox) {
  const std::vector<Eigen::Vector3d> points = {{0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}};
  const std::vector<int> depths = {8, 6};
  const OctreeGrid grid = make_octree_grid(points, depths, 4);
  for (double at = 0.03; at < 0.8; at += 0.05) {
    const Eigen::Vector3d low = Eigen::Vector3d::Constant(at);
    const Eigen::AlignedBox3d box(low, low + Eigen::Vector3d(0.17, 0.11, 0.07));
    std::size_t reaching = 0, active = 0;
    for (const BlockLevel& level : grid.levels) {
      active += level.active;
      for (std::size_t b = 0; b < level.active; ++b) {
        const bool counts = reaches(level.blocks[b], level.depth, box);
        EXPECT_TRUE(counts || !is_needed(level.blocks[b], level.depth, box));
        reaching += counts;
      }
    }
    EXPECT_EQ(octree_blocks(points, depths, 4, box, 1e9).reaching, reaching);
    EXPECT_LT(reaching, active);
  }
}

}  // namespace
}  // namespace scan
