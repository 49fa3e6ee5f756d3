// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/text.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "libscan/core/random.h"

namespace scan {
namespace {

TEST(Numbers, OfAnyBitPatternComeBackToTheBit) {
  RandomStream random(7, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    const auto bits = std::uint64_t{random.bits32()} << 32 | random.bits32();
    const double number = std::bit_cast<double>(bits);
    const auto back = number_from<double>(shortest(number));
    ASSERT_TRUE(back) << shortest(number);
    if (number == number)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(*back), bits) << shortest(number);
    else
      EXPECT_NE(*back, *back);
    const float single = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (single == single) {
      EXPECT_EQ(number_from<float>(shortest(single)), single);
    }
  }
}

TEST(Numbers, AtTheEdgesOfTheirTypeAreExactOrRefused) {
  EXPECT_EQ(number_from<double>("4.9406564584124654e-324"),
            std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(number_from<double>("1e-400"), 0.0);
  EXPECT_EQ(number_from<double>("1e400"), std::nullopt);
  EXPECT_EQ(number_from<float>("1e39"), std::nullopt);
  EXPECT_EQ(number_from<float>("1e-60"), 0.0f);
  EXPECT_EQ(number_from<double>("inf"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(number_from<std::int16_t>("32767"), 32767);
  EXPECT_EQ(number_from<std::int16_t>("32768"), std::nullopt);
  EXPECT_EQ(number_from<std::uint32_t>("-1"), std::nullopt);
}

TEST(Numbers, TakeTheWholeWordOrNothing) {
  for (const char* word :
       {"", "+", "-", "1.5x", "1,5", "0x10", " 1", "1 ", "+-1", "1e", "--1", "abc"})
    EXPECT_EQ(number_from<double>(word), std::nullopt) << "'" << word << "'";
  EXPECT_EQ(number_from<double>("+2.5"), 2.5);
  EXPECT_EQ(number_from<int>("1.0"), std::nullopt);
}

TEST(Lines, EndInAnyOfTheThreeWays) {
  Lines lines("a\nb\r\nc\rd\n\ne");
  std::string joined;
  while (const auto line = lines.next()) joined += std::string(*line) + "|";
  EXPECT_EQ(joined, "a|b|c|d||e|");
  EXPECT_EQ(lines.number(), 6u);
}

}  // namespace
}  // namespace scan
