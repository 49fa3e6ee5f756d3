// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scan {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

// -50 ... 50 mm in steps of 1 mm: mean 0, sum of squares 2 * 50 * 51 * 101 / 6 = 85850.
std::vector<double> ramp() {
  std::vector<double> values = {nan};
  for (int i = -50; i <= 50; ++i) values.push_back(i * 1e-3);
  return values;
}

TEST(DeviationStatistics, OfARampAreItsClosedForms) {
  const DeviationStatistics s = deviation_statistics(ramp());
  EXPECT_EQ(s.count, 101u);
  EXPECT_EQ(s.unknown, 1u);
  EXPECT_NEAR(s.mean_m, 0, 1e-17);  // rounding of 101 sums of 0.05
  EXPECT_NEAR(s.rms_m, std::sqrt(85850.0 / 101) * 1e-3, 1e-15);
  EXPECT_NEAR(s.standard_deviation_m, std::sqrt(85850.0 / 100) * 1e-3, 1e-15);
  EXPECT_EQ(s.least_m, -0.05);
  EXPECT_EQ(s.p05_m, -45e-3);
  EXPECT_EQ(s.median_m, 0);
  EXPECT_EQ(s.p95_m, 45e-3);
  EXPECT_EQ(s.most_m, 0.05);
  // Sizes are 0, 1, 1, 2, 2, ... 50, 50: the sorted list's place k holds (k + 1) / 2.
  EXPECT_EQ(s.size_p95_m, 48e-3);
  EXPECT_EQ(s.size_p997_m, 50e-3);
}

TEST(DeviationStatistics, OfNothingCountNothing) {
  EXPECT_EQ(deviation_statistics({}).count, 0u);
  EXPECT_EQ(deviation_statistics(std::vector<double>{nan}).unknown, 1u);
}

TEST(DeviationHistogram, PutsEachFiniteDeviationIntoOnePlace) {
  const DeviationHistogram h = deviation_histogram(ramp(), 0.0405, 81);
  EXPECT_EQ(h.below, 10u);  // -50 ... -41 mm
  EXPECT_EQ(h.above, 10u);
  for (const std::size_t count : h.counts) EXPECT_EQ(count, 1u);  // bins are 1 mm wide
}

TEST(DeviationHistogram, HoldsItsEnds) {
  const DeviationHistogram h = deviation_histogram(std::vector<double>{-1.0, 1.0}, 1, 4);
  EXPECT_EQ(h.counts, (std::vector<std::size_t>{1, 0, 0, 1}));
  EXPECT_EQ(h.below + h.above, 0u);
}

TEST(WorstPlaces, AreTheLargestThatLieApart) {
  Mesh mesh;
  for (int i = 0; i < 6; ++i) mesh.vertices.emplace_back(i, 0, 0);
  const std::vector<double> deviations = {1, -5, 4, nan, 3, 2};
  EXPECT_EQ(worst_places(mesh, deviations, 3, 1.5), (std::vector<std::uint32_t>{1, 4}));
  EXPECT_EQ(worst_places(mesh, deviations, 3, 0.5), (std::vector<std::uint32_t>{1, 2, 4}));
}

TEST(WorstPlaces, MayLieAsFarApartAsAsked) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {1.5, 0, 0}}, {}};
  const std::vector<double> deviations_m{3, 2, 1};
  EXPECT_EQ(worst_places(mesh, deviations_m, 3, 1), (std::vector<std::uint32_t>{0, 1}));
}

}  // namespace
}  // namespace scan
