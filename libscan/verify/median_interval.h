// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a median lies, by a few independent values and without a word on their distribution.
#pragma once

#include <optional>
#include <span>

namespace scan {

struct MedianInterval {
  double low = 0;
  double median = 0;  // of the values themselves
  double high = 0;
};

// The narrowest pair of order statistics x_(r), x_(n + 1 - r) that misses the median of what the
// values are drawn from with a chance of at most `false_alarm`: 2 P(Binomial(n, 1/2) < r) (Thompson
// 1936). This holds for any distribution, however heavy its tails. None if n is below
// least_count(false_alarm). Sorts the values.
std::optional<MedianInterval> median_interval(std::span<double> values, double false_alarm);

// Values from which on there is such an interval: 2 / 2^n <= false_alarm.
int least_count(double false_alarm);

// The number of standard deviations that a normal variable is off by, to either side, with that
// chance: 1.96 for 0.05.
double normal_limit(double false_alarm);

}  // namespace scan
