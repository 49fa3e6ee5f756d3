// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The figures that every error is summarised by.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libscan/verify/verdict.h"

namespace scan {

// All are NaN over nothing; sums are taken in order, so they do not depend on threads.
double mean(std::span<const double> values);
double root_mean_square(std::span<const double> values);

// The smallest value that at least `share` (0 to 1) of the values do not exceed (nearest rank); NaN
// if any value is NaN.
double quantile(std::span<const double> values, double share);

// The quantile between whose ranks that of the whole population lies with 95 % confidence: n share
// and 1.96 sqrt(n share (1 - share)) to either side (normal approximation of the binomial count of
// values below it). None where these ranks leave the list.
std::optional<Interval> quantile_interval(std::span<const double> values, double share);

// 1.96 standard errors to either side of the mean, and of the root of the mean square by its
// derivative. None over fewer than two values.
std::optional<Interval> mean_interval(std::span<const double> values);
std::optional<Interval> root_mean_square_interval(std::span<const double> values);

// Of a share of a population, from the share of n drawn ones (Wilson 1927): inside 0 to 1, and open
// towards the middle where all or none of them count.
Interval share_interval(double share, std::size_t n);

// prefix_mean, _rms, _median, _p95, _p997 and _max of unsigned errors. With `drawn`, the values are
// a random sample and the figures carry their intervals; the maximum has none, but by the rule of
// three at most 3 / n of the population exceeds it, which its `over` says.
enum class Values { all, drawn };
std::vector<Measurement> summary(const std::string& prefix, std::span<const double> errors,
                                 const std::string& unit, const std::string& over, Values values);

}  // namespace scan
