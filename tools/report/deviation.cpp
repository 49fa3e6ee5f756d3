// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/deviation.h"

#include <algorithm>
#include <cmath>

namespace scan {
namespace {

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(
      std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

}  // namespace

DeviationStatistics deviation_statistics(std::span<const double> deviations_m) {
  std::vector<double> sorted;
  for (const double d : deviations_m)
    if (std::isfinite(d)) sorted.push_back(d);
  DeviationStatistics found{.count = sorted.size(), .unknown = deviations_m.size() - sorted.size()};
  if (sorted.empty()) return found;
  std::sort(sorted.begin(), sorted.end());
  const auto count = static_cast<double>(sorted.size());
  double sum = 0, squares = 0, scatter = 0;
  for (const double d : sorted) sum += d, squares += d * d;
  found.mean_m = sum / count;
  for (const double d : sorted) scatter += (d - found.mean_m) * (d - found.mean_m);
  found.standard_deviation_m = sorted.size() > 1 ? std::sqrt(scatter / (count - 1)) : 0;
  found.rms_m = std::sqrt(squares / count);
  found.least_m = sorted.front();
  found.p05_m = quantile(sorted, 0.05);
  found.median_m = quantile(sorted, 0.5);
  found.p95_m = quantile(sorted, 0.95);
  found.most_m = sorted.back();
  for (double& d : sorted) d = std::abs(d);
  std::sort(sorted.begin(), sorted.end());
  found.size_p95_m = quantile(sorted, 0.95);
  found.size_p997_m = quantile(sorted, 0.997);
  return found;
}

DeviationHistogram deviation_histogram(std::span<const double> deviations_m, double limit_m,
                                       std::size_t bins) {
  DeviationHistogram histogram{.limit_m = limit_m, .counts = std::vector<std::size_t>(bins, 0)};
  for (const double d : deviations_m) {
    if (!std::isfinite(d)) continue;
    const double place = (d / limit_m + 1) / 2 * static_cast<double>(bins);
    if (place < 0)
      ++histogram.below;
    else if (d > limit_m)
      ++histogram.above;
    else
      ++histogram.counts[std::min(static_cast<std::size_t>(place), bins - 1)];
  }
  return histogram;
}

std::vector<std::uint32_t> worst_places(const Mesh& mesh, std::span<const double> deviations_m,
                                        std::size_t count, double apart_m) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < deviations_m.size(); ++i)
    if (std::isfinite(deviations_m[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::abs(deviations_m[a]) > std::abs(deviations_m[b]);
  });
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t i : order) {
    if (chosen.size() >= count) break;
    const bool near = std::any_of(chosen.begin(), chosen.end(), [&](std::uint32_t k) {
      return (mesh.vertices[i] - mesh.vertices[k]).norm() < apart_m;
    });
    if (!near) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace scan
