// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Mean, root mean square, quantiles, their intervals, and the figures of an error.
#include "libscan/verify/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>

namespace scan {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double confident = 1.959964;  // standard deviations that hold 95 % of a normal variable

// Of the mean of `values` around their known `centre`.
double standard_error(std::span<const double> values, double centre) {
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  const auto n = static_cast<double>(values.size());
  return std::sqrt(sum / (n - 1) / n);
}

// What a sample of n says of the part that lies beyond its largest value, with 95 % confidence.
std::string beyond(std::size_t n) {
  char text[64];
  std::snprintf(text, sizeof text, "; at most %.1g of all lies beyond",
                3.0 / static_cast<double>(n));
  return text;
}

// The values at ranks 1 ... n of the sorted list; NaN if any value is NaN.
std::vector<double> at_ranks(std::span<const double> values, std::initializer_list<double> ranks) {
  const bool undefined =
      std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
  if (values.empty() || undefined) return std::vector<double>(ranks.size(), not_a_number);
  std::vector<double> sorted(values.begin(), values.end()), found;
  for (const double rank : ranks) {
    const auto index = std::min(static_cast<std::size_t>(std::max(rank, 1.0)), sorted.size()) - 1;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(index),
                     sorted.end());
    found.push_back(sorted[index]);
  }
  return found;
}

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
  return at_ranks(values, {std::ceil(share * static_cast<double>(values.size()))}).front();
}

std::optional<Interval> quantile_interval(std::span<const double> values, double share) {
  const auto n = static_cast<double>(values.size());
  const double spread = confident * std::sqrt(n * share * (1 - share));
  const double low = std::floor(n * share - spread), high = std::ceil(n * share + spread) + 1;
  if (!(low >= 1) || !(high <= n)) return std::nullopt;
  const auto ends = at_ranks(values, {low, high});
  if (std::isnan(ends[0])) return std::nullopt;
  return Interval{ends[0], ends[1]};
}

std::optional<Interval> mean_interval(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double centre = mean(values);
  const double half = confident * standard_error(values, centre);
  return Interval{centre - half, centre + half};
}

std::optional<Interval> root_mean_square_interval(std::span<const double> values) {
  if (values.size() < 2) return std::nullopt;
  const double rms = root_mean_square(values);
  if (!(rms > 0)) return Interval{rms, rms};
  std::vector<double> squares;
  squares.reserve(values.size());
  for (const double value : values) squares.push_back(value * value);
  const double half = confident * standard_error(squares, rms * rms) / (2 * rms);
  return Interval{std::max(0.0, rms - half), rms + half};
}

Interval share_interval(double share, std::size_t n) {
  const double count = static_cast<double>(n), z2 = confident * confident;
  const double centre = (share + z2 / (2 * count)) / (1 + z2 / count);
  const double half = confident / (1 + z2 / count) *
                      std::sqrt(share * (1 - share) / count + z2 / (4 * count * count));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

std::vector<Measurement> summary(const std::string& prefix, std::span<const double> errors,
                                 const std::string& unit, const std::string& over, Values values) {
  std::vector<Measurement> figures;
  const auto add = [&](const char* suffix, double value, const auto& interval) {
    figures.push_back({.name = prefix + suffix,
                       .value = value,
                       .unit = unit,
                       .over = over,
                       .count = errors.size()});
    if (values == Values::drawn) figures.back().interval = interval();
  };
  add("_mean", mean(errors), [&] { return mean_interval(errors); });
  add("_rms", root_mean_square(errors), [&] { return root_mean_square_interval(errors); });
  add("_median", quantile(errors, 0.5), [&] { return quantile_interval(errors, 0.5); });
  add("_p95", quantile(errors, 0.95), [&] { return quantile_interval(errors, 0.95); });
  add("_p997", quantile(errors, 0.997), [&] { return quantile_interval(errors, 0.997); });
  add("_max", quantile(errors, 1), [] { return std::nullopt; });
  if (values == Values::drawn && !errors.empty()) figures.back().over += beyond(errors.size());
  return figures;
}

}  // namespace scan
