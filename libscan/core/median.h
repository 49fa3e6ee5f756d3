// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The middle one of numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan {

// The least value that at least `share` of them do not exceed; 0 for none.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const double place = std::ceil(share * static_cast<double>(values.size())) - 1;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(0.0, place));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The upper of the two middle ones; 0 for none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace scan
