// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Shared noise has the variance 1 and the correlation that Scan::noise_window states.
#include "tools/noise_field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scan {
namespace {

// Of n draws a product of two normal numbers of correlation q has the mean q +- sqrt((1 + q^2) /
// n); five of these. Rays: (2, 3) of a grid of 20 columns and those so many rows and columns on.
TEST(NoiseField, IsCorrelatedAsTheWindowsOverlap) {
  constexpr std::uint32_t columns = 20, n = 20000;
  const auto ray = [](std::uint32_t row, std::uint32_t column) { return row * columns + column; };
  for (const RayGrid window : {RayGrid{1, 1}, RayGrid{3, 5}})
    for (const auto& [rows, across] : {std::pair(0u, 0u), {0u, 2u}, {1u, 0u}, {2u, 4u}, {3u, 0u}}) {
      const std::vector<std::uint32_t> rays = {ray(2 + rows, 3 + across), ray(2, 3), ray(9, 0)};
      double sum = 0;
      for (std::uint32_t draw = 0; draw < n; ++draw) {
        const NoiseField noise(rays, columns, window, {7, 4, draw});
        sum += noise.at(rays[0]) * noise.at(rays[1]);
      }
      const auto overlap = [](double apart, double of) { return std::max(0.0, 1 - apart / of); };
      const double q = overlap(rows, window.rows) * overlap(across, window.columns);
      EXPECT_NEAR(sum / n, q, 5 * std::sqrt((1 + q * q) / n)) << rows << " " << across;
    }
}

}  // namespace
}  // namespace scan
