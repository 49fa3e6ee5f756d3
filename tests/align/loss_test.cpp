// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/loss.h"

#include <gtest/gtest.h>

#include <limits>

namespace scan {
namespace {

// Central differences with h = 1e-6: off by h^2 |rho'''| / 6 + eps rho / h < 1e-9 for rho up to 1.
TEST(WelschLoss, WeightAndCurvatureAreItsDerivatives) {
  const WelschLoss loss{.scale_m = 0.7};
  for (const double r : {-1.9, -0.5, 0.1, 1.0, 2.5}) {
    EXPECT_NEAR((loss.rho_m2(r + 1e-6) - loss.rho_m2(r - 1e-6)) / 2e-6 / r, loss.weight(r), 1e-8);
    const double above = (r + 1e-6) * loss.weight(r + 1e-6),
                 below = (r - 1e-6) * loss.weight(r - 1e-6);
    EXPECT_NEAR((above - below) / 2e-6, loss.curvature(r), 1e-8);
  }
}

TEST(WelschLoss, IsQuadraticNearZeroAndConstantFarOff) {
  const WelschLoss loss{.scale_m = 2};
  EXPECT_NEAR(loss.rho_m2(1e-4), 0.5e-8, 1e-17);
  EXPECT_EQ(loss.weight(0), 1);
  EXPECT_EQ(loss.rho_m2(1e9), 4);
  EXPECT_EQ(loss.rho_m2(std::numeric_limits<double>::infinity()), 4);
}

}  // namespace
}  // namespace scan
