// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/descriptor_matches.h"

#include <gtest/gtest.h>

#include <set>

#include "libscan/core/parallel.h"
#include "tests/align/global_scenes.h"

namespace scan {
namespace {

ScanFeatures features(std::size_t count, std::uint64_t seed) {
  return describe(test::lump(count, seed), 0.1);
}

double distance2(const ScanFeatures& a, std::size_t i, const ScanFeatures& b, std::size_t j) {
  double sum = 0;
  for (std::size_t k = 0; k < ScanFeatures::dimensions; ++k) {
    const double off = double(a.descriptors[i * ScanFeatures::dimensions + k]) -
                       b.descriptors[j * ScanFeatures::dimensions + k];
    sum += off * off;
  }
  return sum;
}

// The indices of the two of b nearest to i of a.
std::set<std::uint32_t> nearest_two(const ScanFeatures& a, std::size_t i, const ScanFeatures& b) {
  std::vector<std::pair<double, std::uint32_t>> all;
  for (std::uint32_t j = 0; j < b.cloud.size(); ++j) all.emplace_back(distance2(a, i, b, j), j);
  std::partial_sort(all.begin(), all.begin() + 2, all.end());
  return {all[0].second, all[1].second};
}

// Single precision may swap two that are equally far to 1e-6: of some 1,500 points, none or few.
TEST(DescriptorMatches, AreTheNearestOfEachOther) {
  const ScanFeatures a = features(2500, 1), b = features(2500, 2);
  std::set<std::pair<std::uint32_t, std::uint32_t>> expected, found;
  for (std::uint32_t i = 0; i < a.cloud.size(); ++i)
    for (const std::uint32_t j : nearest_two(a, i, b))
      if (nearest_two(b, j, a).contains(i)) expected.emplace(i, j);
  for (const DescriptorMatch& match : match_descriptors(a, b, 100000))
    found.emplace(match.source, match.target);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> apart;
  std::set_symmetric_difference(expected.begin(), expected.end(), found.begin(), found.end(),
                                std::back_inserter(apart));
  ASSERT_GT(expected.size(), 300u);
  EXPECT_LE(apart.size(), 2u);
}

TEST(DescriptorMatches, ComeInOrderAndAreBounded) {
  const ScanFeatures a = features(2500, 1), b = features(2500, 2);
  const auto all = match_descriptors(a, b, 100000), few = match_descriptors(a, b, 100);
  ASSERT_EQ(few.size(), 100u);
  for (std::size_t k = 0; k < few.size(); ++k) {
    EXPECT_EQ(few[k].source, all[k].source);
    EXPECT_LE(few[k > 0 ? k - 1 : 0].distance, few[k].distance);
  }
}

TEST(DescriptorMatches, OfAScanWithItselfHoldEachPoint) {
  const ScanFeatures a = features(1500, 1);
  std::size_t same = 0;
  for (const DescriptorMatch& match : match_descriptors(a, a, 100000))
    same += match.source == match.target;
  EXPECT_EQ(same, a.cloud.size());
}

TEST(DescriptorMatches, AreTheSameForAnyNumberOfThreads) {
  const ScanFeatures a = features(2500, 1), b = features(2500, 2);
  std::vector<std::vector<float>> distances;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    distances.emplace_back();
    for (const DescriptorMatch& match : match_descriptors(a, b, 500))
      distances.back().push_back(match.distance);
  }
  EXPECT_EQ(distances[0], distances[1]);
  EXPECT_EQ(distances[0], distances[2]);
}

TEST(DescriptorMatches, OfNothingAreNone) {
  EXPECT_TRUE(match_descriptors({}, features(1500, 1), 10).empty());
  EXPECT_TRUE(match_descriptors(features(1500, 1), {}, 10).empty());
}

}  // namespace
}  // namespace scan
