// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Means over windows of independent numbers are correlated by the share that the windows have in
// common.
#include "tools/shared_normals.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

using Normals = std::vector<std::array<double, artefact_draws>>;

Normals independent_normals(std::size_t rays, const NoiseAddress& address) {
  Normals normals(rays);
  parallel_for(
      rays,
      [&](std::size_t ray) {
        RandomStream random(address.seed, address.scan, ray);
        for (double& normal : normals[ray]) normal = random.normal();
      },
      256);
  return normals;
}

// Sums over `window` neighbours along one axis of a grid, of variance 1 again. `stride`: from one
// to the next; the grid's end leaves a shorter sum.
Normals summed(const Normals& values, std::size_t stride, std::size_t length, std::size_t window) {
  Normals sums(values.size());
  parallel_for(
      values.size(),
      [&](std::size_t i) {
        const std::size_t count = std::min(window, length - i / stride % length);
        const double weight = 1 / std::sqrt(static_cast<double>(count));
        for (std::size_t k = 0; k < count; ++k)
          for (std::size_t draw = 0; draw < artefact_draws; ++draw)
            sums[i][draw] += weight * values[i + k * stride][draw];
      },
      256);
  return sums;
}

}  // namespace

Normals shared_normals(const Scan& scan, const NoiseAddress& address) {
  const std::size_t rows = scan.grid.rows, columns = scan.grid.columns;
  const RayGrid& window = scan.noise_window;
  if (rows * columns == 0 || (window.rows == 1 && window.columns == 1)) {
    const auto last = std::max_element(scan.ray.begin(), scan.ray.end());
    return independent_normals(last == scan.ray.end() ? 0 : *last + std::size_t{1}, address);
  }
  const Normals own = independent_normals(rows * columns, address);
  return summed(summed(own, 1, columns, window.columns), columns, rows, window.rows);
}

}  // namespace scan
