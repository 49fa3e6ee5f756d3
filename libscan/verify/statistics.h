// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The figures that every error is summarised by.
#pragma once

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

// prefix_mean, prefix_rms, prefix_p95 and prefix_max of unsigned errors.
std::vector<Measurement> summary(const std::string& prefix, std::span<const double> errors,
                                 const std::string& unit, const std::string& over);

}  // namespace scan
