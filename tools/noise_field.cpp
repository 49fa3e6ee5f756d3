// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/noise_field.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/random.h"

namespace scan {

NoiseField::NoiseField(std::span<const std::uint32_t> rays, std::uint32_t columns, RayGrid window,
                       const NoiseAddress& address)
    : columns_(columns), window_(window) {
  if (rays.empty()) return;
  const auto by_column = [&](std::uint32_t a, std::uint32_t b) {
    return a % columns < b % columns;
  };
  const auto [top, bottom] = std::minmax_element(rays.begin(), rays.end());
  const auto [left, right] = std::minmax_element(rays.begin(), rays.end(), by_column);
  first_row_ = *top / columns_, first_column_ = *left % columns_;
  const std::size_t rows = *bottom / columns_ - first_row_ + window_.rows;
  width_ = *right % columns_ - first_column_ + window_.columns + 1;
  sums_.assign((rows + 1) * width_, 0);
  for (std::size_t r = 0; r < rows; ++r) {
    double row_sum = 0;
    for (std::size_t c = 0; c + 1 < width_; ++c) {
      const std::uint64_t ray = (first_row_ + r) * columns_ + first_column_ + c;
      row_sum += RandomStream(address.seed, address.scan, (std::uint64_t{address.draw} << 32) + ray)
                     .normal();
      sums_[(r + 1) * width_ + c + 1] = sum_before(r, c + 1) + row_sum;
    }
  }
}

double NoiseField::at(std::uint32_t ray) const {
  const std::size_t row = ray / columns_ - first_row_, column = ray % columns_ - first_column_;
  const std::size_t below = row + window_.rows, right = column + window_.columns;
  return (sum_before(below, right) - sum_before(row, right) - sum_before(below, column) +
          sum_before(row, column)) /
         std::sqrt(static_cast<double>(window_.rows) * window_.columns);
}

}  // namespace scan
