// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/nearest_word.h"

#include <gtest/gtest.h>

namespace scan {
namespace {

TEST(NearestWord, TakesTheNearestAndNothingTooFar) {
  EXPECT_EQ(nearest_word("spere", {"sphere", "box"}), "sphere");
  EXPECT_EQ(nearest_word("zebra", {"sphere", "box"}), "");
}

}  // namespace
}  // namespace scan
