// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulse_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan::synth {
namespace {

double share_between(double sigma, double from, double to) {
  const double scale = 1 / (std::numbers::sqrt2 * sigma);
  return from > 0 ? 0.5 * (std::erfc(from * scale) - std::erfc(to * scale))
                  : 0.5 * (std::erf(to * scale) - std::erf(from * scale));
}

// See the header: 6e-12 by the series, 6e-14 beyond the reach.
constexpr double error_share = 6.1e-12;

TEST(PulseTable, HoldsTheIntegralsOfAGaussian) {
  for (const double sigma : {0.12, 0.5, 1.0, 1.5, 3.7, 20.0}) {
    const PulseTable table(sigma);
    ASSERT_TRUE(table.exists()) << sigma;
    for (double middle = 150; middle < 151; middle += 0.00137) {
      std::vector<double> samples(400, 2.0);
      const PulseTable::Place place = table.place(middle);
      const SampleRange touched = table.touched(place, samples.size());
      table.add(place, 1000, touched, &samples[touched.first]);
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double off = static_cast<double>(i) - middle;
        const double pulse = 1000 * share_between(sigma, off - 0.5, off + 0.5);
        ASSERT_NEAR(samples[i], 2 + pulse, 1000 * error_share + 1e-12) << sigma << ' ' << middle;
        if (i < touched.first || i >= touched.behind) {
          ASSERT_EQ(samples[i], 2.0);
        }
      }
    }
  }
}

TEST(PulseTable, CutsPulsesAtTheWindowsEnds) {
  const double sigma = 1.5;
  const PulseTable table(sigma);
  for (double middle = -30; middle < 50; middle += 0.31) {
    std::vector<double> samples(20, 0.0);
    const PulseTable::Place place = table.place(middle);
    const SampleRange touched = table.touched(place, samples.size());
    table.add(place, 1, touched, samples.data() + touched.first);
    EXPECT_LE(touched.first, touched.behind);
    EXPECT_LE(touched.behind, samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double off = static_cast<double>(i) - middle;
      ASSERT_NEAR(samples[i], share_between(sigma, off - 0.5, off + 0.5), error_share) << middle;
    }
  }
}

TEST(PulseTable, IsNotBuiltBeyondItsSize) {
  EXPECT_FALSE(PulseTable(1e-6).exists());
  EXPECT_FALSE(PulseTable(1e6).exists());
}

TEST(PulseTable, GivesTheSameBytesByEveryKernel) {
  constexpr std::size_t count = 37;
  std::vector<double> series;
  for (std::size_t i = 0; i < count * PulseTable::terms; ++i)
    series.push_back(std::sin(static_cast<double>(i * i)));
  std::vector<double> plain(count, 0.5);
  pulse_kernels().front()(series.data(), count, 0.043, 1234.5, plain.data(), count);
  for (PulseKernel* const kernel : pulse_kernels()) {
    std::vector<double> other(count, 0.5);
    kernel(series.data(), count, 0.043, 1234.5, other.data(), count);
    EXPECT_EQ(plain, other);
  }
}

}  // namespace
}  // namespace scan::synth
