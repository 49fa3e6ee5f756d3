// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The figures of small lists, counted by hand.
#include "libscan/verify/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

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
  const auto figures = summary("error", values, "m", "values");
  EXPECT_EQ(figure(figures, "error_p95"), 95);
  EXPECT_EQ(figure(figures, "error_max"), 100);
  EXPECT_EQ(measurement(figures, "error_mean").count, 100u);
}

TEST(Statistics, OfNothingOrOfNaNIsNaN) {
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_TRUE(std::isnan(root_mean_square({})));
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  const std::vector<double> values{1, std::nan(""), 2};
  EXPECT_TRUE(std::isnan(quantile(values, 1)));
}

}  // namespace
}  // namespace scan
