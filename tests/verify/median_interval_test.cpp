// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/median_interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "libscan/core/random.h"

namespace scan {
namespace {

// Table: of 20 values the 6th and the 15th miss the median with 2 P(Binomial(20, 1/2) < 6) = 0.0414
// (David and Nagaraja 2003, section 7.1); of 6 the extremes with 2 / 64.
TEST(MedianInterval, TakesTheOrderStatisticsOfTheTable) {
  std::vector<double> values;
  for (int i = 20; i >= 1; --i) values.push_back(i);
  const auto interval = median_interval(values, 0.05);
  ASSERT_TRUE(interval);
  EXPECT_EQ(interval->low, 6);
  EXPECT_EQ(interval->median, 10.5);
  EXPECT_EQ(interval->high, 15);
  EXPECT_EQ(median_interval(values, 0.0413)->low, 5);
  std::vector<double> six = {3, 1, 2, 6, 5, 4};
  EXPECT_EQ(median_interval(six, 2.0 / 64)->low, 1);
  EXPECT_FALSE(median_interval(six, 2.0 / 65));
}

TEST(MedianInterval, NeedsAsManyValuesAsItSays) {
  for (const double false_alarm : {0.5, 0.05, 1e-3, 1e-6}) {
    std::vector<double> values(static_cast<std::size_t>(least_count(false_alarm)));
    EXPECT_TRUE(median_interval(values, false_alarm)) << false_alarm;
    values.pop_back();
    EXPECT_FALSE(median_interval(values, false_alarm)) << false_alarm;
  }
}

// Cauchy's distribution has neither mean nor variance. 25 values allow 2 P(Binomial(25, 1/2) < 8) =
// 0.0433: of 4000 intervals 173 +- 13 miss, so 120 to 226 within four standard deviations.
TEST(MedianInterval, CoversTheMedianOfHeavyTails) {
  RandomStream random(1, 0, 0);
  int missed = 0;
  for (int i = 0; i < 4000; ++i) {
    std::vector<double> values(25);
    for (double& x : values) x = 7 + std::tan(std::numbers::pi * (random.uniform() - 0.5));
    const auto interval = median_interval(values, 0.05);
    missed += interval->low > 7 || interval->high < 7;
  }
  EXPECT_GT(missed, 120);
  EXPECT_LT(missed, 226);
}

TEST(NormalLimit, IsThatOfTheTables) {
  EXPECT_NEAR(normal_limit(0.05), 1.959964, 1e-6);
  EXPECT_NEAR(normal_limit(0.3173105), 1, 1e-6);
  EXPECT_NEAR(normal_limit(1e-6), 4.891638, 1e-6);
}

}  // namespace
}  // namespace scan
