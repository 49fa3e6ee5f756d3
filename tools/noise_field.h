// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Noise of the rays of one scan, shared by those around as the scan says of itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libscan/core/scan.h"

namespace scan {

struct NoiseAddress {
  std::uint64_t seed = 0;
  std::uint32_t scan = 0, draw = 0;
};

// Normal numbers of variance 1. Those of two rays are correlated as Scan::noise_window states it:
// each is the sum of a white field over a window of so many rays. Rays are row * columns + column.
class NoiseField {
 public:
  NoiseField(std::span<const std::uint32_t> rays, std::uint32_t columns, RayGrid window,
             const NoiseAddress& address);
  double at(std::uint32_t ray) const;  // one of the rays

 private:
  double sum_before(std::size_t row, std::size_t column) const {
    return sums_[row * width_ + column];
  }

  std::size_t columns_;
  RayGrid window_;
  std::size_t first_row_ = 0, first_column_ = 0, width_ = 0;
  std::vector<double> sums_;  // of the white field over all rows and columns before
};

}  // namespace scan
