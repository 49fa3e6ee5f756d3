// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/median_interval.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan {
namespace {

// The largest r with 2 P(Binomial(n, 1/2) < r) <= false_alarm; 0 if there is none.
std::size_t interval_rank(std::size_t n, double false_alarm) {
  double term = std::exp2(-static_cast<double>(n)), below = 0;  // P(= r), P(< r)
  std::size_t r = 0;
  while (2 * r < n && 2 * (below + term) <= false_alarm) {
    below += term;
    term *= static_cast<double>(n - r) / static_cast<double>(r + 1);
    ++r;
  }
  return r;
}

}  // namespace

std::optional<MedianInterval> median_interval(std::span<double> values, double false_alarm) {
  const std::size_t n = values.size(), r = interval_rank(n, false_alarm);
  if (r == 0) return std::nullopt;
  std::sort(values.begin(), values.end());
  return MedianInterval{.low = values[r - 1],
                        .median = (values[(n - 1) / 2] + values[n / 2]) / 2,
                        .high = values[n - r]};
}

int least_count(double false_alarm) {
  return std::max(1, static_cast<int>(std::ceil(1 - std::log2(false_alarm))));
}

double normal_limit(double false_alarm) {
  double low = 0, high = 40;  // by bisection: erfc falls
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::erfc(middle / std::numbers::sqrt2) > false_alarm ? low : high) = middle;
  }
  return high;
}

}  // namespace scan
