// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Means over windows of independent numbers are correlated by the share that the windows have in
// common.
#include "tools/shared_normals.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/random.h"

namespace scan {
namespace {

// A part of the grid that holds some rays and, below and right of each, its window.
struct Part {
  std::size_t row = 0, column = 0, rows = 0, columns = 0;
};

Part part_of(const RayNoise& noise, std::span<const std::uint32_t> rays) {
  std::size_t top = noise.grid.rows, left = noise.grid.columns, bottom = 0, right = 0;
  for (const std::uint32_t ray : rays) {
    const std::size_t row = ray / noise.grid.columns, column = ray % noise.grid.columns;
    top = std::min(top, row), bottom = std::max(bottom, row);
    left = std::min(left, column), right = std::max(right, column);
  }
  return {top, left, bottom - top + noise.window.rows, right - left + noise.window.columns};
}

// Sums over `window` values `stride` apart, of variance 1 again; those whose window would leave the
// part hold nothing of use.
void sum_windows(std::vector<double>& values, std::size_t stride, std::size_t window) {
  const double weight = 1 / std::sqrt(static_cast<double>(window));
  for (std::size_t i = 0; i + (window - 1) * stride < values.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < window; ++k) sum += values[i + k * stride];
    values[i] = weight * sum;
  }
}

}  // namespace

std::vector<double> shared_normals(const RayNoise& noise, std::span<const std::uint32_t> rays,
                                   std::uint64_t seed, std::uint32_t draw) {
  const auto own = [&](std::uint64_t ray) {
    return RandomStream(seed, noise.scan, (std::uint64_t{draw} << 32) + ray).normal();
  };
  std::vector<double> normals;
  normals.reserve(rays.size());
  if (rays.empty() || (noise.window.rows == 1 && noise.window.columns == 1)) {
    for (const std::uint32_t ray : rays) normals.push_back(own(ray));
    return normals;
  }
  const Part part = part_of(noise, rays);
  std::vector<double> values(part.rows * part.columns);
  // Windows may reach beyond the grid; rays are then numbered as if it were as wide.
  const std::uint64_t width = noise.grid.columns + noise.window.columns;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = own((part.row + i / part.columns) * width + part.column + i % part.columns);
  sum_windows(values, 1, noise.window.columns);
  sum_windows(values, part.columns, noise.window.rows);
  for (const std::uint32_t ray : rays)
    normals.push_back(values[(ray / noise.grid.columns - part.row) * part.columns +
                             ray % noise.grid.columns - part.column]);
  return normals;
}

}  // namespace scan
