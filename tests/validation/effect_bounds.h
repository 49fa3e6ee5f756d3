// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far ranges move if an effect is left out, against the planner's bound.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "synth/effects/weight.h"

namespace scan::synth {

// The largest error over the rays with what it is sure to be at least and at most: each ray's mean
// over renderings -+ five standard errors; exact where a rendering holds no chance.
struct LargestError {
  double least_m = 0;
  double most_m = 0;
  int rays = 0;
};

// `errors_m(seed)`: range with the effect minus range without, ray by ray; NaN for a miss.
inline LargestError largest_error(
    int renderings, const std::function<std::vector<double>(std::uint64_t)>& errors_m) {
  std::vector<double> sum, squares;
  for (int seed = 0; seed < renderings; ++seed) {
    const auto errors = errors_m(seed);
    sum.resize(errors.size(), 0);
    squares.resize(errors.size(), 0);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      sum[i] += errors[i];
      squares[i] += errors[i] * errors[i];
    }
  }
  LargestError largest;
  const double n = renderings;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (std::isnan(sum[i])) continue;
    const double mean = sum[i] / n;
    const double error =
        n > 1 ? std::sqrt(std::max(squares[i] / n - mean * mean, 0.0) / (n - 1)) : 0;
    largest.least_m = std::max(largest.least_m, std::abs(mean) - 5 * error);
    largest.most_m = std::max(largest.most_m, std::abs(mean) + 5 * error);
    ++largest.rays;
  }
  return largest;
}

inline std::vector<double> minus(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

template <class Scanner>
double bound_m(const Scanner& scanner, const Scene& scene, Effect effect) {
  const RayCaster caster(scene);
  const Weighed weighed =
      weigh(scanner, scene, effect, pilot(scanner, caster, Pose::Identity(), 2000));
  EXPECT_TRUE(weighed.weight) << weighed.why_absent;
  return weighed.weight ? weighed.weight->bound_m : 0;
}

// Within the bound, and the bound not ten times too large; `slack_m`: what else moves ranges.
inline void expect_met(const char* what, const LargestError& error, double bound_m,
                       double slack_m = 0) {
  std::printf("bound: %-24s %9.4g mm, error %.4g to %.4g mm, %.2f of it\n", what, bound_m * 1e3,
              error.least_m * 1e3, error.most_m * 1e3, error.least_m / bound_m);
  ASSERT_GT(error.rays, 0);
  EXPECT_LE(error.most_m, bound_m + slack_m);
  EXPECT_GE(error.least_m, bound_m / 10 + slack_m);
}

}  // namespace scan::synth
