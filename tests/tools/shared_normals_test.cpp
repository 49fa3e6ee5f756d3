// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/shared_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace scan {
namespace {

std::vector<std::uint32_t> all_rays(const RayGrid& grid) {
  std::vector<std::uint32_t> rays(grid.rows * grid.columns);
  std::iota(rays.begin(), rays.end(), 0u);
  return rays;
}

constexpr std::uint32_t draws = 7;

// Mean product of a draw's number at a ray and of another draw's so many rows and columns on.
double product(const RayNoise& noise, std::size_t rows, std::size_t columns,
               std::uint32_t draw_apart) {
  double sum = 0, count = 0;
  for (std::uint32_t draw = 0; draw < draws; ++draw) {
    const auto one = shared_normals(noise, all_rays(noise.grid), 5, draw),
               other = shared_normals(noise, all_rays(noise.grid), 5, draw + draw_apart);
    for (std::size_t row = 0; row + rows < noise.grid.rows; ++row)
      for (std::size_t column = 0; column + columns < noise.grid.columns; ++column, ++count)
        sum += one[row * noise.grid.columns + column] *
               other[(row + rows) * noise.grid.columns + column + columns];
  }
  return sum / count;
}

// Means over windows of 5 by 3 of so many normals scatter by sqrt(2 S / n): S, the squared
// correlations' sum, is about (2 / 3 5) (2 / 3 3) = 7, n = 7 200 300 = 420,000: 0.006; five of
// these.
TEST(SharedNormals, AreCorrelatedAsTheWindowSays) {
  const RayNoise noise{2, {200, 300}, {5, 3}};
  EXPECT_NEAR(product(noise, 0, 0, 0), 1, 0.03);
  EXPECT_NEAR(product(noise, 2, 0, 0), 0.6, 0.03);
  EXPECT_NEAR(product(noise, 0, 1, 0), 2.0 / 3, 0.03);
  EXPECT_NEAR(product(noise, 2, 1, 0), 0.4, 0.03);
  EXPECT_NEAR(product(noise, 5, 0, 0), 0, 0.03);
  EXPECT_NEAR(product(noise, 0, 3, 0), 0, 0.03);
  EXPECT_NEAR(product(noise, 0, 0, 1), 0, 0.03);
}

TEST(SharedNormals, OfRaysWithNoiseOfTheirOwnAreIndependent) {
  const RayNoise noise{2, {200, 300}};
  EXPECT_NEAR(product(noise, 0, 0, 0), 1, 5 * std::sqrt(2 / 420e3));
  EXPECT_NEAR(product(noise, 1, 0, 0), 0, 5 * std::sqrt(1 / 420e3));
  EXPECT_NEAR(product(noise, 0, 1, 0), 0, 5 * std::sqrt(1 / 420e3));
}

// Of some rays they are what they are of all.
TEST(SharedNormals, BelongToSeedScanDrawAndRay) {
  for (const RayGrid window : {RayGrid{1, 1}, RayGrid{5, 3}}) {
    const RayNoise noise{2, {20, 30}, window};
    const auto all = shared_normals(noise, all_rays(noise.grid), 5, 1);
    const std::vector<std::uint32_t> rays = {599, 247, 250, 331};
    const auto some = shared_normals(noise, rays, 5, 1);
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(some[i], all[rays[i]]);
    EXPECT_NE(shared_normals(noise, rays, 6, 1), some);
    EXPECT_NE(shared_normals(noise, rays, 5, 2), some);
    EXPECT_NE(shared_normals({3, noise.grid, window}, rays, 5, 1), some);
    EXPECT_TRUE(shared_normals(noise, {}, 5, 1).empty());
  }
}

}  // namespace
}  // namespace scan
