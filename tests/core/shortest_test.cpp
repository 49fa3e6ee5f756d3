// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/shortest.h"

#include <gtest/gtest.h>

#include <limits>

namespace scan {
namespace {

TEST(Shortest, IsShortAndReadsBack) {
  EXPECT_EQ(shortest(1.2), "1.2");
  EXPECT_EQ(shortest(-3), "-3");
  EXPECT_EQ(shortest(1e-9), "1e-09");
  EXPECT_EQ(shortest(std::numeric_limits<double>::quiet_NaN()), "nan");
  for (const double number : {0.1 + 0.2, 1.0 / 3, 1e300, 2.3e-308, 123456789.123})
    EXPECT_EQ(std::stod(shortest(number)), number);
}

}  // namespace
}  // namespace scan
