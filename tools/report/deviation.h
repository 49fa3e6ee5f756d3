// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the report tells of a list of signed deviations: statistics, histogram, the worst places.
#pragma once

#include <span>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

// Of the finite ones. Quantiles are those of the sorted list at the nearest place.
struct DeviationStatistics {
  std::size_t count = 0, unknown = 0;  // unknown: not finite
  double mean_m = 0, standard_deviation_m = 0, rms_m = 0;
  double least_m = 0, p05_m = 0, median_m = 0, p95_m = 0, most_m = 0;
  double size_p95_m = 0, size_p997_m = 0;  // of the absolute values
};
DeviationStatistics deviation_statistics(std::span<const double> deviations_m);

// Equal bins over [-limit_m, limit_m]; what lies beyond is counted apart.
struct DeviationHistogram {
  double limit_m = 0;
  std::vector<std::size_t> counts;
  std::size_t below = 0, above = 0;
};
DeviationHistogram deviation_histogram(std::span<const double> deviations_m, double limit_m,
                                       std::size_t bins);

// The vertex of largest absolute deviation, then the next that is at least `apart_m` from all
// before it, and so on; `count` of them at most.
std::vector<std::uint32_t> worst_places(const Mesh& mesh, std::span<const double> deviations_m,
                                        std::size_t count, double apart_m);

}  // namespace scan
