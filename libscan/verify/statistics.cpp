// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Mean, root mean square, quantiles, and the four figures of an error.
#include "libscan/verify/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double mean(std::span<const double> values) {
  if (values.empty()) return not_a_number;
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double root_mean_square(std::span<const double> values) {
  if (values.empty()) return not_a_number;
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double quantile(std::span<const double> values, double share) {
  const bool undefined = std::any_of(values.begin(), values.end(),
                                     [](double value) { return std::isnan(value); });
  if (values.empty() || undefined) return not_a_number;
  std::vector<double> sorted(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const auto index = std::min(static_cast<std::size_t>(std::max(rank, 1.0)), sorted.size()) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(index),
                   sorted.end());
  return sorted[index];
}

std::vector<Measurement> summary(const std::string& prefix, std::span<const double> errors,
                                 const std::string& unit, const std::string& over) {
  const auto figure = [&](const char* suffix, double value) {
    return Measurement{.name = prefix + suffix,
                       .value = value,
                       .unit = unit,
                       .over = over,
                       .count = errors.size()};
  };
  return {figure("_mean", mean(errors)), figure("_rms", root_mean_square(errors)),
          figure("_p95", quantile(errors, 0.95)), figure("_max", quantile(errors, 1))};
}

}  // namespace scan
