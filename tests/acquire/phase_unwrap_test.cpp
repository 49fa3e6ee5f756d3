// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/phase_unwrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/acquire/reason.h"

namespace scan::decoding {
namespace {

// c / 2 gcd: 16, 80, 120 MHz have 8 MHz, 18.74 m.
TEST(Unwrap, PeriodIsThatOfTheCommonDivisor) {
  EXPECT_NEAR(combined_period_m(std::vector{80e6}), 1.874, 0.0005);
  EXPECT_NEAR(combined_period_m(std::vector{16e6, 80e6, 120e6}), 18.737, 0.0005);
}

FoldedDistance fold(double distance_m, double period_m, double sigma_m) {
  return {distance_m - period_m * std::floor(distance_m / period_m), sigma_m, period_m};
}

TEST(Unwrap, FindsEveryWrapOfThreePeriods) {
  for (double distance = 0.3; distance < 29.7; distance += 0.0371) {
    const std::vector<FoldedDistance> folded{fold(distance, 3, 0.02), fold(distance, 2, 0.01),
                                             fold(distance, 10, 0.05)};
    const UnwrappedDistance found = unwrap(folded, 30, 4);
    ASSERT_EQ(found.miss, "") << distance;
    EXPECT_NEAR(found.distance_m, distance, 1e-9);
    EXPECT_NEAR(found.sigma_m, 1 / std::sqrt(2500 + 1e4 + 400), 1e-9);
  }
}

// Equal frequencies tell nothing of the wrap; so do ones whose noise is half the difference.
TEST(Unwrap, IsAmbiguousWhereTwoFoldsFitAlike) {
  EXPECT_EQ(unwrap(std::vector{fold(1, 3, 0.01), fold(1, 3, 0.01)}, 10, 4).miss, reason::ambiguous);
  EXPECT_EQ(unwrap(std::vector{fold(1, 3, 0.1), fold(1, 2.8, 0.1)}, 10, 4).miss, reason::ambiguous);
  EXPECT_EQ(unwrap(std::vector{fold(1, 3, 0.01), fold(1, 2.8, 0.01)}, 10, 4).miss, "");
}

// Residuals of 3 and 5 sigma (of their own scatter, sigma / sqrt(2) for two equal ones).
TEST(Unwrap, GatesInconsistentFrequencies) {
  const auto with = [](double difference_m) {
    return unwrap(std::vector{fold(1, 3, 0.01), fold(1 + difference_m, 2, 0.01)}, 5.9, 4);
  };
  EXPECT_EQ(with(3 * 0.01 * std::sqrt(2.0)).miss, "");
  EXPECT_EQ(with(5 * 0.01 * std::sqrt(2.0)).miss, reason::inconsistent);
}

TEST(Unwrap, KnowsTheEndsOfTheRange) {
  EXPECT_EQ(unwrap(std::vector{fold(2.5, 3, 0.01)}, 2, 4).miss, reason::out_of_range);
  EXPECT_EQ(unwrap(std::vector{fold(2.99, 3, 0.01)}, 2, 4).miss, reason::out_of_range);  // -0.01 m
  EXPECT_EQ(unwrap(std::vector{fold(2.99, 3, 0.01)}, 3, 4).miss, reason::ambiguous);
  EXPECT_EQ(unwrap(std::vector{fold(0.01, 3, 0.01)}, 3, 4).miss, reason::ambiguous);
  EXPECT_NEAR(unwrap(std::vector{fold(0.01, 3, 0.01)}, 2, 4).distance_m, 0.01, 1e-12);
}

}  // namespace
}  // namespace scan::decoding
