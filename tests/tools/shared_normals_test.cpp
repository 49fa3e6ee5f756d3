// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/shared_normals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scan {
namespace {

constexpr NoiseAddress address{5, 2};

Scan scan_of(RayGrid grid, RayGrid window) {
  Scan scan;
  scan.grid = grid;
  scan.noise_window = window;
  for (std::uint32_t ray = 0; ray < grid.rows * grid.columns; ++ray) scan.ray.push_back(ray);
  return scan;
}

// Mean product of a draw's number at a ray and another's so many rows and columns on.
double product(const Scan& scan, std::size_t rows, std::size_t columns, std::size_t draw_apart) {
  const auto normals = shared_normals(scan, address);
  double sum = 0, count = 0;
  for (std::size_t row = 0; row + rows < scan.grid.rows; ++row)
    for (std::size_t column = 0; column + columns < scan.grid.columns; ++column)
      for (std::size_t draw = 0; draw + draw_apart < artefact_draws; ++draw, ++count)
        sum += normals[row * scan.grid.columns + column][draw] *
               normals[(row + rows) * scan.grid.columns + column + columns][draw + draw_apart];
  return sum / count;
}

// Means over windows of 5 by 3 of so many normals scatter by sqrt(2 S / n): S, the squared
// correlations' sum, is about (2 / 3 5) (2 / 3 3) = 7, n = 7 200 300 = 420,000: 0.006; five of
// these.
TEST(SharedNormals, AreCorrelatedAsTheWindowSays) {
  const Scan scan = scan_of({200, 300}, {5, 3});
  EXPECT_NEAR(product(scan, 0, 0, 0), 1, 0.03);
  EXPECT_NEAR(product(scan, 2, 0, 0), 0.6, 0.03);
  EXPECT_NEAR(product(scan, 0, 1, 0), 2.0 / 3, 0.03);
  EXPECT_NEAR(product(scan, 2, 1, 0), 0.4, 0.03);
  EXPECT_NEAR(product(scan, 5, 0, 0), 0, 0.03);
  EXPECT_NEAR(product(scan, 0, 3, 0), 0, 0.03);
  EXPECT_NEAR(product(scan, 0, 0, 1), 0, 0.03);
}

TEST(SharedNormals, OfRaysWithNoiseOfTheirOwnAreIndependent) {
  const Scan scan = scan_of({200, 300}, {1, 1});
  EXPECT_NEAR(product(scan, 0, 0, 0), 1, 5 * std::sqrt(2 / 420e3));
  EXPECT_NEAR(product(scan, 1, 0, 0), 0, 5 * std::sqrt(1 / 420e3));
  EXPECT_NEAR(product(scan, 0, 1, 0), 0, 5 * std::sqrt(1 / 420e3));
}

TEST(SharedNormals, BelongToSeedScanAndRay) {
  Scan scan = scan_of({20, 30}, {1, 1});
  const auto normals = shared_normals(scan, address);
  EXPECT_NE(shared_normals(scan, {6, 2})[7], normals[7]);
  EXPECT_NE(shared_normals(scan, {5, 3})[7], normals[7]);
  scan.ray = {7};
  EXPECT_EQ(shared_normals(scan, address).size(), 8);
  EXPECT_EQ(shared_normals(scan, address)[7], normals[7]);
  scan.ray = {};
  EXPECT_TRUE(shared_normals(scan, address).empty());
}

}  // namespace
}  // namespace scan
