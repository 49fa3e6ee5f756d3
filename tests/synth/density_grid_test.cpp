// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/density_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "libscan/core/error.h"
#include "tests/synth/density_grids.h"

namespace scan::synth {
namespace {

TEST(DensityGrid, IsTrilinearBetweenCellCentres) {
  const DensityGrid grid = cloud_with_holes();
  const Eigen::Vector3d cell_m = grid.box_m.sizes().cwiseQuotient(grid.cells.cast<double>());
  EXPECT_NEAR(density_at(grid, grid.box_m.min() + 0.5 * cell_m), grid.density[0], 1e-14);
  EXPECT_NEAR(
      density_at(grid, grid.box_m.min() + cell_m.cwiseProduct(Eigen::Vector3d(18.5, 4.5, 9.5))),
      grid.density[(9 * 10 + 4) * 21 + 18], 1e-13);
  RandomStream random(1, 1, 1);
  for (int i = 0; i < 5000; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Eigen::Vector3d at =
        grid.box_m.min() + Eigen::Vector3d(x, y, z).cwiseProduct(grid.box_m.sizes());
    // roundings of the place, 1e-16 times 21 cells, times a slope of 1 per cell
    ASSERT_NEAR(density_at(grid, at), trilinear(grid, at), 1e-13);
  }
  EXPECT_EQ(density_at(grid, grid.box_m.max() + Eigen::Vector3d(1e-9, 0, 0)), 0);
  EXPECT_GT(density_at(grid, grid.box_m.max()), 0) << "level up to the box";
}

struct HalfLine {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

// Random lines; every third along an axis, every second from within the box.
HalfLine half_line(const DensityGrid& grid, int i) {
  RandomStream random(2, 0, i);
  Eigen::Vector3d spot, origin, direction;
  for (int axis = 0; axis < 3; ++axis) {
    spot[axis] = grid.box_m.min()[axis] + random.uniform() * grid.box_m.sizes()[axis];
    direction[axis] = random.normal();
  }
  if (i % 3 == 0) direction = (i % 2 ? 1 : -1) * Eigen::Vector3d::Unit(i / 3 % 3);
  direction.normalize();
  origin = spot - (i % 2 ? 0 : 4) * direction;
  return {origin, direction};
}

// The segments follow each other without a gap from where the line enters the box to where it
// leaves it, and no density exceeds their majorant.
TEST(BlockWalk, CoversTheLineWithBounds) {
  DensityGrid grid = cloud_with_holes();
  set_majorants(grid);
  for (int i = 0; i < 600; ++i) {
    const auto [origin, direction] = half_line(grid, i);
    BlockWalk walk(grid, origin, direction, std::numeric_limits<double>::infinity());
    double covered_m = 0, end_m = -1;
    while (const auto segment = walk.next()) {
      if (end_m >= 0) {
        ASSERT_EQ(segment->begin_m, end_m);
      }
      ASSERT_GE(segment->end_m, segment->begin_m);
      end_m = segment->end_m;
      covered_m += segment->end_m - segment->begin_m;
      for (int k = 0; k <= 20; ++k) {
        const double t = segment->begin_m + (segment->end_m - segment->begin_m) * k / 20;
        // an ulp beyond a block's face the density may exceed the bound by its slope times that
        ASSERT_LE(density_at(grid, origin + t * direction), segment->majorant + 1e-13);
      }
    }
    double low = 0, high = 1e9;
    for (int axis = 0; axis < 3; ++axis)
      if (direction[axis] != 0) {
        const double a = (grid.box_m.min()[axis] - origin[axis]) / direction[axis];
        const double b = (grid.box_m.max()[axis] - origin[axis]) / direction[axis];
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
      }
    ASSERT_NEAR(covered_m, high - low, 1e-12) << i;
  }
}

// A block is empty if its own cells and those around it are: of the holes, cells 7 to 16 fill the
// middle column of blocks, cells from 17 on the last one up to z = 8.
TEST(BlockWalk, FindsEmptyBlocks) {
  DensityGrid grid = cloud_with_holes();
  set_majorants(grid);
  ASSERT_EQ(grid.majorants.size(), 3u * 2 * 3);
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        EXPECT_EQ(grid.majorants[(z * 2 + y) * 3 + x] == 0, x == 1 || (x == 2 && z == 0));
}

TEST(BlockWalk, StaysShortOfItsEnd) {
  DensityGrid grid = cloud_with_holes();
  set_majorants(grid);
  const Eigen::Vector3d inside = grid.box_m.center();
  BlockWalk none(grid, inside, Eigen::Vector3d::UnitX(), 0);
  EXPECT_FALSE(none.next());
  BlockWalk away(grid, grid.box_m.max() + Eigen::Vector3d::Ones(), Eigen::Vector3d::UnitX(), 10);
  EXPECT_FALSE(away.next());
  BlockWalk walk(grid, inside, Eigen::Vector3d::UnitX(), 0.25);
  double end_m = 0;
  while (const auto segment = walk.next()) end_m = segment->end_m;
  EXPECT_EQ(end_m, 0.25);
}

std::string complaint_of(const DensityGrid& grid) {
  try {
    check(grid, "fog");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(DensityGrid, NamesWhatIsWrong) {
  EXPECT_EQ(complaint_of(cloud_with_holes()), "");
  DensityGrid grid = cloud_with_holes();
  grid.density[17] = 1.5f;
  EXPECT_EQ(complaint_of(grid), "fog/density[17]: 1.5, must be from 0 to 1");
  grid.density[17] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(complaint_of(grid), "fog/density[17]: nan, must be from 0 to 1");
  grid.density.clear();
  EXPECT_EQ(complaint_of(grid), "fog/density: 0 numbers, must be 3570, one for each cell");
  grid.cells.y() = 0;
  EXPECT_EQ(complaint_of(grid), "fog/cells[y]: 0, must be at least 1");
  grid.box_m.setEmpty();
  EXPECT_NE(complaint_of(grid).find("fog/box_m[x]: size "), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
