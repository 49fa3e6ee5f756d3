// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether draws have the distribution that they should have.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace scan {

// Deviation of chi-square from its mean in standard deviations of a normal variable (Wilson and
// Hilferty 1931): above 4.75 with probability 1e-6.
inline double chi_square_score(const std::vector<double>& observed,
                               const std::vector<double>& expected) {
  double chi2 = 0;
  for (std::size_t i = 0; i < observed.size(); ++i)
    chi2 += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
  const double freedom = static_cast<double>(observed.size()) - 1;
  const double spread = 2 / (9 * freedom);
  return (std::cbrt(chi2 / freedom) - (1 - spread)) / std::sqrt(spread);
}
inline constexpr double one_in_a_million = 4.75;

// Score of values that should be uniform in [0, 1).
inline double uniformity_score(const std::function<double()>& draw, std::size_t count = 400'000) {
  constexpr std::size_t bins = 200;
  std::vector<double> observed(bins, 0), expected(bins, static_cast<double>(count) / bins);
  for (std::size_t i = 0; i < count; ++i)
    observed[std::min<std::size_t>(static_cast<std::size_t>(draw() * bins), bins - 1)] += 1;
  return chi_square_score(observed, expected);
}

}  // namespace scan
