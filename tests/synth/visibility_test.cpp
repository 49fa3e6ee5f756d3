// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/visibility.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace scan::synth {
namespace {

TEST(Visibility, LeavesTheShareOfItsDefinition) {
  EXPECT_NEAR(std::exp(-extinction_by_optical_range(80) * 80), 0.05, 1e-15);
  // 3.91 is ln 50 in three digits: 2 % to half of its last digit
  EXPECT_NEAR(std::exp(-extinction_by_kruse(8000, 550e-9) * 8000), 0.02, 0.02 * 0.005);
  EXPECT_NEAR(std::exp(-extinction_by_kim(300, 550e-9) * 300), 0.02, 0.02 * 0.005);
}

TEST(Visibility, HasKrusesGoldenValues) {
  const std::array<std::array<double, 2>, 5> golden = {
      {{1, 2.658e-3}, {5, 4.041e-4}, {10, 1.658e-4}, {23, 7.209e-5}, {60, 2.267e-5}}};
  for (const auto& [km, per_m] : golden)
    EXPECT_NEAR(extinction_by_kruse(1000 * km, 1064e-9) / per_m, 1, 2.2e-4) << km;  // four digits
}

// Kim's exponent is continuous at 500 m, 1 km and 6 km; in fog colours fade alike.
TEST(Visibility, IsContinuousAfterKim) {
  for (const double m : {500.0, 1000.0, 6000.0}) {
    const double below = extinction_by_kim(m * (1 - 1e-9), 905e-9);
    EXPECT_NEAR(below / extinction_by_kim(m * (1 + 1e-9), 905e-9), 1, 1e-8) << m;
  }
  EXPECT_EQ(extinction_by_kim(200, 905e-9), extinction_by_kim(200, 1550e-9));
  EXPECT_EQ(extinction_by_kim(23000, 905e-9), extinction_by_kruse(23000, 905e-9));
  EXPECT_NEAR(extinction_by_kim(2000, 1550e-9) / extinction_by_kim(2000, 550e-9),
              std::pow(1550.0 / 550, -0.66), 1e-12);
}

}  // namespace
}  // namespace scan::synth
