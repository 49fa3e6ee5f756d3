// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What passes, what fails, and what is no limit at all.
#include "libscan/verify/verdict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libscan/core/error.h"

namespace scan {
namespace {

std::vector<Measurement> measured(double value) {
  return {{.name = "accuracy_rms", .value = value, .unit = "m", .over = "points", .count = 10},
          {.name = "components", .value = 1, .unit = "count", .over = "mesh", .count = 1}};
}

bool passes(double value, const std::string& relation, double limit) {
  return judge(measured(value), {{"accuracy_rms", relation, limit, "why"}}).pass;
}

TEST(Verdict, HoldsTheBorder) {
  EXPECT_TRUE(passes(2, "<=", 2));
  EXPECT_FALSE(passes(2.0000001, "<=", 2));
  EXPECT_TRUE(passes(2, ">=", 2));
  EXPECT_FALSE(passes(1.9999999, ">=", 2));
  EXPECT_TRUE(passes(2, "==", 2));
  EXPECT_FALSE(passes(3, "==", 2));
  EXPECT_TRUE(passes(-2, "within", 2));
  EXPECT_TRUE(passes(2, "within", 2));
  EXPECT_FALSE(passes(-2.5, "within", 2));
  EXPECT_FALSE(passes(2.5, "within", 2));
}

TEST(Verdict, NaNNeverPasses) {
  for (const char* relation : {"<=", ">=", "==", "within"})
    EXPECT_FALSE(passes(std::nan(""), relation, std::numeric_limits<double>::infinity()));
}

TEST(Verdict, CarriesLimitAndReason) {
  const Verdict verdict = judge(measured(3), {{"accuracy_rms", "<=", 2, "noise"}});
  ASSERT_EQ(verdict.measurements.size(), 2u);
  EXPECT_EQ(verdict.measurements[0].limit, 2);
  EXPECT_EQ(verdict.measurements[0].relation, "<=");
  EXPECT_EQ(verdict.measurements[0].reason, "noise");
  EXPECT_FALSE(verdict.measurements[0].pass);
  EXPECT_FALSE(verdict.measurements[1].limit.has_value());
  EXPECT_TRUE(verdict.measurements[1].pass);
  EXPECT_FALSE(verdict.pass);
}

TEST(Verdict, ListsAMeasurementOncePerLimit) {
  const Verdict verdict =
      judge(measured(3), {{"accuracy_rms", "<=", 4, ""}, {"accuracy_rms", ">=", 3.5, ""}});
  ASSERT_EQ(verdict.measurements.size(), 3u);
  EXPECT_TRUE(verdict.measurements[0].pass);
  EXPECT_FALSE(verdict.measurements[1].pass);
  EXPECT_FALSE(verdict.pass);
}

TEST(Verdict, FailsWhicheverLimitIsBroken) {
  EXPECT_FALSE(
      judge(measured(3), {{"accuracy_rms", "<=", 2, ""}, {"components", "==", 1, ""}}).pass);
  EXPECT_FALSE(
      judge(measured(3), {{"accuracy_rms", "<=", 4, ""}, {"components", "==", 2, ""}}).pass);
}

TEST(Verdict, WithoutLimitsPasses) {
  EXPECT_TRUE(judge(measured(1e9), {}).pass);
}

TEST(Verdict, RefusesAnUnmeasuredNameWithAHint) {
  try {
    judge(measured(1), {{"acuracy_rms", "<=", 1, ""}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::input);
    EXPECT_NE(error.hint().find("accuracy_rms"), std::string::npos);
  }
  EXPECT_THROW(judge({}, {{"accuracy_rms", "<=", 1, ""}}), Error);
}

TEST(Verdict, RefusesABrokenLimit) {
  EXPECT_THROW(passes(1, "<", 2), Error);
  EXPECT_THROW(passes(1, "<=", std::nan("")), Error);
}

}  // namespace
}  // namespace scan
