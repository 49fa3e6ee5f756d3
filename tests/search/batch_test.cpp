// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "libscan/search/search.h"
#include "tests/search/clouds.h"

namespace scan {
namespace {

constexpr double spacing_m = 0.05;  // of 1000 points on the unit sphere, about

double length_of_path(const Points& points, const std::vector<std::uint32_t>& order) {
  double sum = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    sum += (points[order[i]] - points[order[i - 1]]).norm();
  return sum;
}

TEST(CurveOrder, NamesEachPointOnceAndTheFiniteFirst) {
  for (const NamedCloud& cloud : hard_clouds(1000)) {
    const Points& points = cloud.points;
    const std::vector<std::uint32_t> order = curve_order(points);
    std::vector<std::uint32_t> sorted = order, all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, all) << cloud.name;
    EXPECT_TRUE(std::is_partitioned(order.begin(), order.end(), [&](auto i) {
      return points[i].allFinite();
    })) << cloud.name;
  }
}

// Random steps between n points of the unit cube have a mean of 0.66; along the curve they are
// about n^(-1/3). A factor of five at 8000 points (0.05) leaves room for the curve's own jumps.
TEST(CurveOrder, MakesShortSteps) {
  const Points points = uniform_cloud(8000);
  std::vector<std::uint32_t> given(points.size());
  std::iota(given.begin(), given.end(), 0u);
  EXPECT_LT(length_of_path(points, curve_order(points)), length_of_path(points, given) / 5);
}

class EachBatch : public testing::TestWithParam<SearchMethod> {
 protected:
  const Points points_ = surface_cloud(3000);
  const Points queries_ = with_holes(moved(surface_cloud(1000), 1.01, {0.01, 0.02, 0}));
  const std::vector<std::uint32_t> order_ = curve_order(queries_);
  const AnySearch any_ = make_search(GetParam(), points_);

  std::vector<Neighbour> one_by_one(double max_distance_m) const {
    std::vector<Neighbour> found;
    for (const auto& query : queries_)
      std::visit(
          [&](const auto& search) {
            const Neighbour none{no_point, unlimited_m};
            found.push_back(search.nearest(query, max_distance_m).value_or(none));
          },
          any_);
    return found;
  }
  void find_each(double max_distance_m, std::vector<Neighbour>& found) const {
    std::visit([&](const auto& s) { nearest_of_each(s, queries_, max_distance_m, order_, found); },
               any_);
  }
};

TEST_P(EachBatch, FindsWhatSingleQueriesFind) {
  for (const double max_distance_m : {unlimited_m, spacing_m, -1.0}) {
    std::vector<Neighbour> found;
    find_each(max_distance_m, found);
    EXPECT_EQ(found, one_by_one(max_distance_m)) << max_distance_m;
  }
}

TEST_P(EachBatch, IsNotMisledByGuesses) {
  RandomStream random(3, 0, 0);
  for (const double max_distance_m : {unlimited_m, spacing_m}) {
    const std::vector<Neighbour> expected = one_by_one(max_distance_m);
    std::vector<Neighbour> right = expected, wrong = expected;
    for (Neighbour& guess : wrong) guess = {random.bits32() % 4000, 0};  // some beyond the points
    find_each(max_distance_m, right);
    find_each(max_distance_m, wrong);
    EXPECT_EQ(right, expected) << max_distance_m;
    EXPECT_EQ(wrong, expected) << max_distance_m;
  }
}

TEST_P(EachBatch, LaysTheKNearestInRows) {
  for (const std::size_t k : {0, 1, 7, 4000}) {
    std::vector<Neighbour> found, row;
    std::visit(
        [&](const auto& search) {
          const std::size_t m = k_nearest_of_each(search, queries_, k, order_, found);
          ASSERT_EQ(m, std::min(k, points_.size()));
          ASSERT_EQ(found.size(), m * queries_.size());
          for (std::size_t i = 0; i < queries_.size(); i += 10) {
            search.k_nearest(queries_[i], k, row);
            row.resize(m, {no_point, unlimited_m});
            EXPECT_TRUE(std::equal(row.begin(), row.end(), found.data() + i * m)) << "query " << i;
          }
        },
        any_);
  }
}

TEST_P(EachBatch, GathersAllWithinARadius) {
  std::visit(
      [&](const auto& search) {
        const Neighbourhoods all = within_of_each(search, queries_, 2 * spacing_m, order_);
        ASSERT_EQ(all.first.size(), queries_.size() + 1);
        EXPECT_EQ(all.first.back(), all.found.size());
        EXPECT_GT(all.found.size(), queries_.size());
        std::vector<Neighbour> mine;
        for (std::size_t i = 0; i < queries_.size(); ++i) {
          search.within(queries_[i], 2 * spacing_m, mine);
          ASSERT_EQ(all.first[i + 1] - all.first[i], mine.size()) << "query " << i;
          EXPECT_TRUE(std::equal(mine.begin(), mine.end(), all.found.data() + all.first[i]));
        }
      },
      any_);
}

TEST_P(EachBatch, AnswersTheSameForAnyNumberOfThreads) {
  std::vector<Neighbour> found[2];
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    find_each(unlimited_m, found[threads == 1 ? 0 : 1]);
  }
  EXPECT_EQ(found[0], found[1]);
}

INSTANTIATE_TEST_SUITE_P(Search, EachBatch,
                         testing::Values(SearchMethod::kd_tree, SearchMethod::octree,
                                         SearchMethod::brute_force, SearchMethod::flann,
                                         SearchMethod::pcl_octree),
                         [](const auto& method) {
                           std::string name(name_of(method.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace scan
