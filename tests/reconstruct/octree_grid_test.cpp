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

// By the definition: what the cells of a finer lattice that meet the box are made of.
TEST(OctreeGrid, CountsTheBlocksThatReachABox) {
  const std::vector<Eigen::Vector3d> points = {{0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}};
  const std::vector<int> depths = {8, 6};
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.3, 0.3, 0.495), Eigen::Vector3d(0.5, 0.6, 0.6));
  std::size_t needed = 0, reaching = 0, active = 0;
  for (const BlockLevel& level : make_octree_grid(points, depths, 4).levels) {
    for (std::size_t b = 0; b < level.active; ++b) {
      const BlockPlace& p = level.blocks[b];
      bool is_needed = true;  // the functions of cell i are i ... i+2
      for (int a = 0; a < 3; ++a) {
        const int first_cell = cell_of(box.min()[a], level.cells());
        const int last_cell = cell_of(box.max()[a], level.cells());
        is_needed &= 4 * p[a] <= last_cell + 2 && 4 * p[a] + 3 >= first_cell;
      }
      needed += is_needed;
      active += 1;
      reaching += reaches(p, level.depth, box);
      EXPECT_TRUE(reaches(p, level.depth, box) || !is_needed);
    }
  }
  EXPECT_EQ(octree_blocks(points, depths, 4, box, 1e9).reaching, reaching);
  EXPECT_GT(needed, 0u);
  EXPECT_LT(reaching, active);
}

}  // namespace
}  // namespace scan
