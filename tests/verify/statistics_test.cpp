// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The figures of small lists, counted by hand.
#include "libscan/verify/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "libscan/core/random.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

TEST(Statistics, OfAListCountedByHand) {
  const std::vector<double> values{3, 1, 4, 1};
  EXPECT_DOUBLE_EQ(mean(values), 2.25);
  EXPECT_DOUBLE_EQ(root_mean_square(values), std::sqrt(27.0 / 4));
  EXPECT_EQ(quantile(values, 0.5), 1);
  EXPECT_EQ(quantile(values, 0.51), 3);
  EXPECT_EQ(quantile(values, 1), 4);
  EXPECT_EQ(quantile(values, 0), 1);
}

TEST(Statistics, P95ExceedsNineteenOfTwenty) {
  std::vector<double> values(100);
  std::iota(values.begin(), values.end(), 1);
  const auto figures = summary("error", values, "m", "values", Values::all);
  EXPECT_EQ(figure(figures, "error_p95"), 95);
  EXPECT_EQ(figure(figures, "error_max"), 100);
  EXPECT_EQ(measurement(figures, "error_mean").count, 100u);
}

// The 95 % interval of a figure misses that of the population in 5 % of the samples: over 2,000
// samples of 400 exponential values (mean 1, rms sqrt 2, median ln 2, p95 ln 20) between 3 and 7 %
// of the intervals, which is four standard deviations, sqrt(0.05 0.95 / 2000) = 0.5 %, to either
// side. The rms of so heavy-tailed a list is skewed: its interval may miss 10 %.
TEST(Statistics, IntervalsHoldTheFigureOfThePopulation) {
  constexpr int samples = 2000;
  int mean_missed = 0, rms_missed = 0, median_missed = 0, p95_missed = 0;
  const auto misses = [](const std::optional<Interval>& interval, double truth) {
    return !interval || truth < interval->low || truth > interval->high;
  };
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    std::vector<double> values;
    for (std::uint64_t i = 0; i < 400; ++i)
      values.push_back(-std::log(1 - RandomStream(5, sample, i).uniform()));
    mean_missed += misses(mean_interval(values), 1);
    rms_missed += misses(root_mean_square_interval(values), std::sqrt(2));
    median_missed += misses(quantile_interval(values, 0.5), std::log(2));
    p95_missed += misses(quantile_interval(values, 0.95), std::log(20));
  }
  for (const int missed : {mean_missed, median_missed, p95_missed}) {
    EXPECT_GT(missed, 0.03 * samples);
    EXPECT_LT(missed, 0.07 * samples);
  }
  EXPECT_GT(rms_missed, 0.03 * samples);
  EXPECT_LT(rms_missed, 0.10 * samples);
}

TEST(Statistics, OnlyDrawnValuesHaveIntervals) {
  std::vector<double> values(1000);
  std::iota(values.begin(), values.end(), 1);
  for (const Measurement& m : summary("error", values, "m", "values", Values::all))
    EXPECT_FALSE(m.interval) << m.name;
  const auto drawn = summary("error", values, "m", "values", Values::drawn);
  EXPECT_TRUE(measurement(drawn, "error_median").interval);
  EXPECT_FALSE(measurement(drawn, "error_max").interval);
  EXPECT_EQ(measurement(drawn, "error_max").over, "values; at most 0.003 of all lies beyond");
  EXPECT_FALSE(quantile_interval(std::vector<double>{1, 2, 3}, 0.997));
  EXPECT_FALSE(mean_interval(std::vector<double>{1}));
}

TEST(Statistics, OfNothingOrOfNaNIsNaN) {
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_TRUE(std::isnan(root_mean_square({})));
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  const std::vector<double> values{1, std::nan(""), 2};
  EXPECT_TRUE(std::isnan(quantile(values, 1)));
}

TEST(Statistics, TheLeastIsTheQuantileOfNothing) {
  const std::vector<double> values{3, 1, 2};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 1.0 / 3), 1);
}

// 0 and 2: their mean has the standard error sqrt((1 + 1) / (2 - 1) / 2) = 1.
TEST(Statistics, OfTwoValuesTheMeanHasAnInterval) {
  const std::vector<double> values{0, 2};
  const auto interval = mean_interval(values);
  ASSERT_TRUE(interval.has_value());
  EXPECT_NEAR(interval->low, 1 - 1.959964, 1e-12);
  EXPECT_NEAR(interval->high, 1 + 1.959964, 1e-12);
  EXPECT_FALSE(mean_interval(std::span(values).first(1)).has_value());
}

// Of 100 values 50 -+ 1.96 * 5 = 40.2 ... 59.8 in rank: outwards to whole ones, and one more above,
// as a quantile lies from a rank to the next. Of 8 the ranks are 1 and 8, of 7 the upper is beyond.
TEST(Statistics, OfTheMedianTheRanksAreCountedByHand) {
  std::vector<double> values(100);
  std::iota(values.begin(), values.end(), 1);
  const auto of_all = quantile_interval(values, 0.5);
  ASSERT_TRUE(of_all.has_value());
  EXPECT_EQ(of_all->low, 40);
  EXPECT_EQ(of_all->high, 61);
  const auto of_eight = quantile_interval(std::span(values).first(8), 0.5);
  ASSERT_TRUE(of_eight.has_value());
  EXPECT_EQ(of_eight->low, 1);
  EXPECT_EQ(of_eight->high, 8);
  EXPECT_FALSE(quantile_interval(std::span(values).first(7), 0.5).has_value());
}

// Where all count, Wilson's interval ends at n / (n + 1.96^2). Of binomial counts its coverage
// swings by 2 % about 95 % (Brown, Cai and DasGupta 2001, figure 5) for shares that n p > 5 tells
// of.
TEST(Statistics, IntervalsOfSharesHoldThem) {
  EXPECT_EQ(share_interval(1, 100).high, 1);
  EXPECT_NEAR(share_interval(1, 100).low, 100 / (100 + 1.959964 * 1.959964), 1e-12);
  EXPECT_EQ(share_interval(0, 100).low, 0);
  for (const double share : {0.03, 0.5, 0.9}) {
    constexpr int samples = 2000, n = 200;
    int held = 0;
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
      int count = 0;
      for (std::uint64_t i = 0; i < n; ++i) count += RandomStream(6, sample, i).uniform() < share;
      const Interval interval = share_interval(static_cast<double>(count) / n, n);
      held += interval.low <= share && share <= interval.high;
    }
    EXPECT_NEAR(held, 0.95 * samples, 0.03 * samples) << share;
  }
}

}  // namespace
}  // namespace scan
