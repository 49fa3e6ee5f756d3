// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/reading_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace scan::synth {
namespace {

using Histogram = std::map<int, double>;

template <class Draw>
Histogram histogram(int count, std::uint64_t seed, const Draw& draw) {
  Histogram result;
  RandomStream random(seed, 0, 0);
  for (int i = 0; i < count; ++i) ++result[draw(random)];
  return result;
}

// Two samples of equal size from one distribution: sum (a - b)^2 / (a + b) is chi-square with as
// many degrees of freedom as cells; cells of fewer than 20 are left out.
void expect_same_distribution(const Histogram& a, const Histogram& b) {
  double chi_square = 0, cells = 0;
  for (const auto& [dn, n] : a) {
    const auto found = b.find(dn);
    const double m = found == b.end() ? 0 : found->second;
    if (n + m < 20) continue;
    chi_square += (n - m) * (n - m) / (n + m);
    ++cells;
  }
  EXPECT_LT(chi_square, cells + 5 * std::sqrt(2 * cells) + 5);
}

void draw(const ReadingTable& table, std::span<std::uint16_t> readings) {
  RandomStream random(3, 0, 0), more(3, 0, 1);
  std::vector<std::uint32_t> words(table.words_for(readings.size()));
  for (std::uint32_t& word : words) word = random.bits32();
  table.draw(words, more, readings);
}

const DetectorEffects effects_list[] = {
    {true, true, true}, {true, true, false}, {true, false, true}, {false, true, true}};

TEST(ReadingTable, DrawsWhatTheDetectorReads) {
  const Sensor sensors[] = {
      {.gain_e_per_dn = 1, .offset_dn = 50, .read_noise_e = 5, .bits = 14},
      {.gain_e_per_dn = 4, .offset_dn = 2, .read_noise_e = 6, .bits = 10},  // clips at 0
      {.gain_e_per_dn = 0.5, .offset_dn = 3, .read_noise_e = 2, .full_well_e = 24}};
  for (const Sensor& sensor : sensors)
    for (const DetectorEffects& effects : effects_list)
      for (const double expected_e : {0.0, 0.3, 5.0, 40.0}) {
        const ReadingTable table(sensor, effects, expected_e);
        expect_same_distribution(
            histogram(40000, 1, [&](RandomStream& random) { return table.draw(random); }),
            histogram(40000, 2, [&](RandomStream& random) {
              return read_pixel(sensor, effects, expected_e, random);
            }));
      }
}

// Rare readings, in the table's last cell: P(N >= 3) = 2.0e-5 of a Poisson number of mean 0.05 (the
// next terms are 1.3 % of the first); over 4e6 draws 80 are expected, 4 sigma are 36.
TEST(ReadingTable, KeepsItsTail) {
  const ReadingTable table({.gain_e_per_dn = 1}, {true, false, true}, 0.05);
  int rare = 0;
  std::vector<std::uint16_t> readings(4'000'000);
  draw(table, readings);
  for (const std::uint16_t dn : readings) rare += dn >= 3;
  const double share = std::exp(-0.05) * std::pow(0.05, 3) / 6 * (1 + 0.05 / 4);
  EXPECT_NEAR(rare, 4e6 * share, 4 * std::sqrt(4e6 * share));
}

// Beyond what draws can show, P(N >= 7) = 1.5e-13 of that Poisson number (the next terms are 0.6 %
// of the first): the reading changes from 6 to 7 at that distance from the end of the
// range, 42 steps of 2^-48.
TEST(ReadingTable, IsRightBeyondThirtyTwoBits) {
  const ReadingTable table({.gain_e_per_dn = 1}, {true, false, true}, 0.05);
  const double share = std::exp(-0.05) * std::pow(0.05, 7) / 5040 * (1 + 0.05 / 8);
  const auto reading = [&](double from_end) {
    return table.reading_at(static_cast<std::uint64_t>(0x1p48 * (1 - from_end)));
  };
  EXPECT_EQ(reading(1.1 * share), 6);
  EXPECT_EQ(reading(0.9 * share), 7);
  EXPECT_EQ(table.reading_at(0), 0);
}

TEST(ReadingTable, IsConstantWithoutNoise) {
  const ReadingTable table({.gain_e_per_dn = 2, .offset_dn = 10}, {false, false, true}, 7);
  std::vector<std::uint16_t> readings(100);
  draw(table, readings);
  for (const std::uint16_t dn : readings) EXPECT_EQ(dn, 14);  // 3.5 + 10 rounds away from zero
}

// A table as wide as this is not built; the numbers come from the detector's model itself.
TEST(ReadingTable, ReadsStrongLightAsTheDetectorDoes) {
  const Sensor sensor{.gain_e_per_dn = 20, .read_noise_e = 1000};
  const ReadingTable table(sensor, {true, true, true}, 1e6);
  double sum = 0, sum2 = 0;
  RandomStream random(4, 0, 0);
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const double off_e = table.draw(random) * 20.0 - 1e6;
    sum += off_e;
    sum2 += off_e * off_e;
  }
  const double variance = 1e6 + 1e6 + 400 / 12.0;
  EXPECT_NEAR(sum / count, 0, 5 * std::sqrt(variance / count));
  EXPECT_NEAR(sum2 / count / variance, 1, 5 * std::sqrt(2.0 / count));
}

}  // namespace
}  // namespace scan::synth
