// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/row_reader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scan::synth {
namespace {

// Of a row that is dark but for every third pixel.
std::vector<double> dotted_row(std::size_t pixels, double lit_e) {
  std::vector<double> row_e(pixels, 0.0);
  for (std::size_t i = 0; i < pixels; i += 3) row_e[i] = lit_e;
  return row_e;
}

TEST(RowReader, ReadsWithoutNoiseAsTheDetectorDoes) {
  const Sensor sensor{.gain_e_per_dn = 3, .offset_dn = 7, .full_well_e = 9000, .bits = 12};
  const DetectorEffects effects{false, false, true};
  const RowReader reader(sensor, effects);
  std::vector<double> row_e = dotted_row(101, 0);
  for (std::size_t i = 0; i < row_e.size(); i += 2) row_e[i] = 200.0 * static_cast<double>(i);
  std::vector<std::uint16_t> readings(row_e.size());
  RowReader::Memory memory;
  reader.read({}, 5, row_e, readings, memory);
  RandomStream none(0, 0, 0);
  for (std::size_t i = 0; i < row_e.size(); ++i)
    EXPECT_EQ(readings[i], read_pixel(sensor, effects, row_e[i], none)) << i;
}

// Mean and variance of dark and of lit pixels over 2000 rows: with n readings the mean is off by
// sigma / sqrt(n) and the variance by sqrt(2 / n) of itself (a little more by its excess, 1 /
// mean); five of these. Read by the closed form (4 electrons of read noise) and one by one (2, and
// few electrons).
TEST(RowReader, DrawsShotAndReadNoise) {
  struct Case {
    double read_e, lit_e;
  };
  for (const auto& [read_e, lit_e] : {Case{10, 300}, {4, 3}, {2, 5}, {0, 80}}) {
    const Sensor sensor{.gain_e_per_dn = 1, .offset_dn = 100, .read_noise_e = read_e};
    const RowReader reader(sensor, {true, true, true});
    const std::vector<double> row_e = dotted_row(101, lit_e);
    std::vector<std::uint16_t> readings(row_e.size());
    RowReader::Memory memory;
    double n[2] = {}, sum[2] = {}, squares[2] = {};
    for (std::uint64_t row = 0; row < 2000; ++row) {
      reader.read({.seed = 3, .scan = 1}, row, row_e, readings, memory);
      for (std::size_t i = 0; i < row_e.size(); ++i) {
        const int kind = row_e[i] > 0;
        const double off_e = readings[i] - 100.0 - row_e[i];
        ++n[kind], sum[kind] += off_e, squares[kind] += off_e * off_e;
      }
    }
    for (int kind = 0; kind < 2; ++kind) {
      const double light_e = kind * lit_e;
      const double rounding = read_e > 0 ? 1.0 / 12 : 0;  // whole electrons are whole numbers
      const double variance = light_e + read_e * read_e + rounding;
      EXPECT_NEAR(sum[kind] / n[kind], 0, 5 * std::sqrt(variance / n[kind])) << read_e;
      const double excess = variance > 0 ? light_e / (variance * variance) : 0;
      EXPECT_NEAR(squares[kind] / n[kind], variance,
                  5 * variance * std::sqrt((2 + excess) / n[kind]))
          << read_e << ' ' << lit_e;
    }
  }
}

// Rows, scans and seeds have streams of their own, and storage leaves no trace.
TEST(RowReader, DrawsEachRowByItsOwnStream) {
  const RowReader reader({.gain_e_per_dn = 1, .offset_dn = 100, .read_noise_e = 10}, {});
  const std::vector<double> row_e = dotted_row(101, 50);
  RowReader::Memory shared;
  const auto read = [&](const RenderAddress& address, std::uint64_t ray, RowReader::Memory& m) {
    std::vector<std::uint16_t> readings(row_e.size());
    reader.read(address, ray, row_e, readings, m);
    return readings;
  };
  const auto first = read({.seed = 1, .scan = 2}, 3, shared);
  EXPECT_NE(first, read({.seed = 1, .scan = 2}, 4, shared));
  EXPECT_NE(first, read({.seed = 1, .scan = 3}, 3, shared));
  EXPECT_NE(first, read({.seed = 2, .scan = 2}, 3, shared));
  RowReader::Memory own;
  EXPECT_EQ(first, read({.seed = 1, .scan = 2}, 3, own));
}

}  // namespace
}  // namespace scan::synth
