// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/phase_unwrap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "libscan/acquire/reason.h"
#include "libscan/core/units.h"

namespace scan::decoding {
namespace {

struct Candidate {
  double distance_m = 0;
  double chi_square = std::numeric_limits<double>::infinity();
  double worst_sigmas = 0;  // largest residual of a frequency over its standard deviation
};

double joint_sigma_m(std::span<const FoldedDistance> folded) {
  double information = 0;
  for (const FoldedDistance& one : folded) information += 1 / (one.sigma_m * one.sigma_m);
  return 1 / std::sqrt(information);
}

double nearest_unfolding_m(const FoldedDistance& one, double distance_m) {
  return one.distance_m + one.period_m * std::round((distance_m - one.distance_m) / one.period_m);
}

// The weighted mean of the unfoldings nearest to `near_m`, and how well they agree.
Candidate rate(std::span<const FoldedDistance> folded, double near_m, double joint_m) {
  Candidate candidate{near_m, 0, 0};
  double shift = 0;
  for (const FoldedDistance& one : folded)
    shift += (nearest_unfolding_m(one, near_m) - near_m) / (one.sigma_m * one.sigma_m);
  candidate.distance_m += shift * joint_m * joint_m;
  for (const FoldedDistance& one : folded) {
    const double residual = nearest_unfolding_m(one, candidate.distance_m) - candidate.distance_m;
    const double variance = one.sigma_m * one.sigma_m;
    candidate.chi_square += residual * residual / variance;
    if (variance > joint_m * joint_m)  // a residual from the mean has the variance's difference
      candidate.worst_sigmas = std::max(
          candidate.worst_sigmas, std::abs(residual) / std::sqrt(variance - joint_m * joint_m));
  }
  return candidate;
}

}  // namespace

double combined_period_m(std::span<const double> frequencies_hz) {
  long long divisor = 0;
  for (const double frequency : frequencies_hz)
    divisor = std::gcd(divisor, std::llround(frequency));
  return speed_of_light_m_s / (2.0 * static_cast<double>(divisor));
}

UnwrappedDistance unwrap(std::span<const FoldedDistance> folded, double range_m,
                         double gate_sigmas) {
  const FoldedDistance& reference = *std::min_element(
      folded.begin(), folded.end(),
      [](const FoldedDistance& a, const FoldedDistance& b) { return a.sigma_m < b.sigma_m; });
  const double joint_m = joint_sigma_m(folded);
  const double margin_m = gate_sigmas * joint_m;
  Candidate best, second;
  const auto wraps_to = [&](double distance_m) {
    return std::llround((distance_m - reference.distance_m) / reference.period_m);
  };
  const std::int64_t last = wraps_to(range_m + margin_m) + 1;
  for (std::int64_t wraps = wraps_to(-margin_m) - 1; wraps <= last; ++wraps) {
    const double distance_m =
        reference.distance_m + static_cast<double>(wraps) * reference.period_m;
    const Candidate one = rate(folded, distance_m, joint_m);
    if (one.distance_m < -margin_m || one.distance_m > range_m + margin_m) continue;
    if (one.chi_square < best.chi_square)
      second = std::exchange(best, one);
    else if (one.chi_square < second.chi_square)
      second = one;
  }
  if (!std::isfinite(best.chi_square)) return {.miss = reason::out_of_range};
  if (best.worst_sigmas > gate_sigmas) return {.miss = reason::inconsistent};
  if (second.chi_square - best.chi_square < gate_sigmas * gate_sigmas)
    return {.miss = reason::ambiguous};
  if (best.distance_m < 0 || best.distance_m > range_m) return {.miss = reason::out_of_range};
  return {.distance_m = best.distance_m, .sigma_m = joint_m};
}

}  // namespace scan::decoding
