// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Quantiles against closed forms and tables.
#include "libscan/verify/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"

namespace scan {
namespace {

// Of 2 m degrees: 1 - e^-h (1 + h + h^2 / 2 + ... + h^(m - 1) / (m - 1)!) at h = x / 2.
double even_share(double x, int m) {
  double beyond = 0;
  for (int k = 0; k < m; ++k) beyond += std::exp(k * std::log(x / 2) - x / 2 - std::lgamma(k + 1));
  return 1 - beyond;
}

TEST(ChiSquare, OfTwoDegreesIsALogarithm) {
  for (const double share : {0.001, 0.025, 0.5, 0.975, 0.9999})
    EXPECT_NEAR(chi_square_quantile(share, 2), -2 * std::log(1 - share), 1e-11);
}

// The sum's terms have log-gammas of some 5e5 (m = 5e4), known to 1e-16 of that each.
TEST(ChiSquare, OfEvenDegreesEndsThePoissonSum) {
  for (const int m : {1, 3, 50, 50'000})
    for (const double share : {0.025, 0.5, 0.975})
      EXPECT_NEAR(even_share(chi_square_quantile(share, 2 * m), m), share, 1e-9) << m;
}

// Abramowitz and Stegun, table 26.8, and more digits of the same.
TEST(ChiSquare, IsThatOfTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841458820694124, 1e-12);
  EXPECT_NEAR(chi_square_quantile(0.95, 6), 12.591587243743977, 1e-12);
  EXPECT_NEAR(chi_square_quantile(0.025, 1), 0.000982069117175, 1e-14);
  EXPECT_NEAR(chi_square_quantile(0.025, 10), 3.24697, 5e-6);
  EXPECT_NEAR(chi_square_quantile(0.975, 10), 20.4832, 5e-5);
}

TEST(ChiSquare, RefusesWhatHasNoQuantile) {
  EXPECT_THROW(chi_square_quantile(0, 1), Error);
  EXPECT_THROW(chi_square_quantile(1, 1), Error);
  EXPECT_THROW(chi_square_quantile(0.5, 0), Error);
}

}  // namespace
}  // namespace scan
