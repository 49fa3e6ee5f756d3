// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Values as a user reads them.
#include "tools/console.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace scan {
namespace {

// What rounds to 1000 of a unit is 1 of the next.
TEST(ReadableLength, HasThreeDigitsOfTheUnitThatSuits) {
  EXPECT_EQ(readable_length(0), "0 m");
  EXPECT_EQ(readable_length(1.234e-9), "1.23 nm");
  EXPECT_EQ(readable_length(1.2e-12), "0.0012 nm");
  EXPECT_EQ(readable_length(-1.62e-17), "-1.62e-17 m");
  EXPECT_EQ(readable_length(0.99949e-6), "999 nm");
  EXPECT_EQ(readable_length(0.9996e-6), "1 um");
  EXPECT_EQ(readable_length(0.9996e-3), "1 mm");
  EXPECT_EQ(readable_length(0.99949), "999 mm");
  EXPECT_EQ(readable_length(0.9996), "1 m");
  EXPECT_EQ(readable_length(-0.00123), "-1.23 mm");
  EXPECT_EQ(readable_length(std::numeric_limits<double>::quiet_NaN()), "unknown");
}

TEST(ReadableValue, FollowsTheUnit) {
  EXPECT_EQ(readable_value(0.002, "m"), "2 mm");
  EXPECT_EQ(readable_value(std::numbers::pi / 2, "rad"), "90 deg");
  EXPECT_EQ(readable_value(1234567, "count"), "1234567");
  EXPECT_EQ(readable_value(0.123456, "1"), "0.1235");
}

}  // namespace
}  // namespace scan
