// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Every model of NeighbourSearch against an oracle of its own: all squared distances, sorted.
#include "libscan/search/search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libscan/core/parallel.h"
#include "tests/search/clouds.h"

namespace scan {
namespace {

constexpr SearchMethod methods[] = {SearchMethod::kd_tree, SearchMethod::octree,
                                    SearchMethod::brute_force, SearchMethod::flann,
                                    SearchMethod::pcl_octree};
static_assert(std::size(methods) == std::variant_size_v<AnySearch>);

using Answer = std::vector<Neighbour>;

// All finite points by (distance, index).
Answer sorted_by_distance(const Points& points, const Eigen::Vector3d& query) {
  Answer all;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite())
      all.push_back({static_cast<std::uint32_t>(i), squared_distance_m2(points[i], query)});
  std::sort(all.begin(), all.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::pair(a.distance2_m2, a.index) < std::pair(b.distance2_m2, b.index);
  });
  return all;
}

Answer first(const Answer& all, std::size_t k) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(k, all.size()))};
}

// How the oracle bounds a distance: as the contract says, by radius * radius, inclusive.
Answer within_of(const Answer& all, double radius_m) {
  Answer kept;
  for (const Neighbour& n : all)
    if (n.distance2_m2 <= radius_m * radius_m) kept.push_back(n);
  return kept;
}

Eigen::Vector3d first_finite(const Points& points) {
  for (const auto& point : points)
    if (point.allFinite()) return point;
  return Eigen::Vector3d::Zero();
}

// At the points, between them, around them at several distances, and far outside.
Points queries_for(const Points& points) {
  RandomStream random(12, 0, 0);
  const Eigen::Vector3d base = first_finite(points);
  double size = 1e-9;
  for (const auto& point : points)
    if (point.allFinite()) size = std::max(size, (point - base).norm());
  Points queries = {base, base + Eigen::Vector3d(1e3, -2e3, 1e3) * size,
                    base + Eigen::Vector3d(1e9, 1e9, -3e9) * size};
  for (int i = 0; i < 12 && !points.empty(); ++i) {
    const Eigen::Vector3d point = points[random.bits32() % points.size()];
    const Eigen::Vector3d step = size * std::pow(10.0, -i) * normal_vector(random);
    if (!point.allFinite()) continue;
    queries.push_back(point + step);
    queries.push_back(i % 2 == 0 ? point : Eigen::Vector3d((point + base) / 2));
  }
  return queries;
}

// Radii at which an inclusive bound tells: the square root of a squared distance, and its
// neighbours, so that points lie exactly on the sphere for many of them.
std::vector<double> radii_for(const Answer& all) {
  std::vector<double> radii = {0, -1, unlimited_m, std::nan("")};
  for (const std::size_t rank : {0, 1, 9, 60}) {
    if (rank >= all.size()) continue;
    const double radius = std::sqrt(all[rank].distance2_m2);
    for (const double r : {radius, std::nextafter(radius, 0.0), std::nextafter(radius, 1e300)})
      radii.push_back(r);
  }
  return radii;
}

class EachMethod : public testing::TestWithParam<SearchMethod> {
 protected:
  // Calls test(search, cloud, query, oracle's list) for each cloud and query.
  template <class Test>
  void for_each_case(std::size_t count, Test&& test) {
    for (const NamedCloud& cloud : hard_clouds(count)) {
      const Points& points = cloud.points;
      SCOPED_TRACE(std::string(name_of(GetParam())) + " on the cloud " + cloud.name);
      const AnySearch any = make_search(GetParam(), points);
      std::visit(
          [&](const auto& search) {
            for (const auto& query : queries_for(points))
              test(search, points, query, sorted_by_distance(points, query));
          },
          any);
      if (HasFailure()) return;
    }
  }
};

TEST_P(EachMethod, CountsTheFinitePoints) {
  for_each_case(100, [](const auto& search, const Points& points, const auto&, const Answer&) {
    const auto finite = std::count_if(points.begin(), points.end(),
                                      [](const auto& point) { return point.allFinite(); });
    EXPECT_EQ(search.size(), static_cast<std::size_t>(finite));
  });
}

TEST_P(EachMethod, FindsTheNearestPoint) {
  for_each_case(2000, [](const auto& search, const Points&, const auto& query, const Answer& all) {
    const std::optional<Neighbour> found = search.nearest(query);
    ASSERT_EQ(found.has_value(), !all.empty());
    if (found) {
      EXPECT_EQ(*found, all.front());
    }
  });
}

TEST_P(EachMethod, TakesTheNearestUpToAndOnTheLimit) {
  for_each_case(500, [](const auto& search, const Points&, const auto& query, const Answer& all) {
    for (const double radius : radii_for(all)) {
      const Answer expected = first(within_of(all, radius >= 0 ? radius : std::nan("")), 1);
      const std::optional<Neighbour> found = search.nearest(query, radius);
      ASSERT_EQ(found.has_value(), !expected.empty()) << "radius " << radius;
      if (found) {
        EXPECT_EQ(*found, expected.front()) << "radius " << radius;
      }
    }
  });
}

TEST_P(EachMethod, FindsTheKNearestPoints) {
  for_each_case(700, [](const auto& search, const Points&, const auto& query, const Answer& all) {
    for (const std::size_t k : {0, 1, 2, 10, 64, 65, 300, 100000}) {
      Answer found = {{7, 7}};  // must be written over
      search.k_nearest(query, k, found);
      EXPECT_EQ(found, first(all, k)) << "k " << k;
    }
  });
}

TEST_P(EachMethod, FindsAllWithinARadiusAndOnIt) {
  for_each_case(700, [](const auto& search, const Points&, const auto& query, const Answer& all) {
    for (const double radius : radii_for(all)) {
      Answer found = {{7, 7}};
      search.within(query, radius, found);
      EXPECT_EQ(found, within_of(all, radius >= 0 ? radius : std::nan(""))) << "radius " << radius;
    }
  });
}

TEST_P(EachMethod, FindsNothingForAQueryThatIsNotFinite) {
  const AnySearch any = make_search(GetParam(), uniform_cloud(100));
  for (const double bad : {std::nan(""), unlimited_m, -unlimited_m})
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d query(0.1, 0.2, 0.3);
      query[axis] = bad;
      std::visit(
          [&](const auto& search) {
            Answer found = {{7, 7}};
            EXPECT_FALSE(search.nearest(query));
            search.k_nearest(query, 3, found);
            EXPECT_TRUE(found.empty());
            search.within(query, unlimited_m, found);
            EXPECT_TRUE(found.empty());
          },
          any);
    }
}

TEST_P(EachMethod, ResolvesPointsThatAreOneInFloat) {
  // A million steps of 1e-9 m beside a point a kilometre off: 1e-9 / 1e3 is far below float's 6e-8.
  Points points = {{1000, 0, 0}};
  for (int i = 0; i < 1000; ++i) points.emplace_back(1e-9 * ((i * 383) % 1000), 0, 0);
  const AnySearch any = make_search(GetParam(), points);
  for (int i = 0; i < 1000; i += 37) {
    const Eigen::Vector3d query(1e-9 * i + 1e-10, 1e-7, 0);
    const auto found = std::visit([&](const auto& search) { return search.nearest(query); }, any);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, sorted_by_distance(points, query).front());
  }
}

TEST_P(EachMethod, AnswersAreTheSameForAnyNumberOfThreads) {
  const Points points = surface_cloud(30000);
  std::vector<Answer> answers[2];
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const AnySearch any = make_search(GetParam(), points);
    auto& mine = answers[threads == 1 ? 0 : 1];
    mine.resize(200);
    parallel_for(mine.size(), [&](std::size_t i) {
      std::visit([&](const auto& search) { search.k_nearest(points[i * 149], 5, mine[i]); }, any);
    });
  }
  EXPECT_EQ(answers[0], answers[1]);
}

TEST_P(EachMethod, SurvivesBeingMoved) {
  AnySearch first_home = make_search(GetParam(), uniform_cloud(50));
  const AnySearch second_home = std::move(first_home);
  std::visit([](const auto& search) { EXPECT_EQ(search.size(), 50u); }, second_home);
  EXPECT_EQ(second_home.index(), static_cast<std::size_t>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Search, EachMethod, testing::ValuesIn(methods), [](const auto& method) {
  std::string name(name_of(method.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(SearchMethod, NamesGoThereAndBack) {
  for (const SearchMethod method : methods) EXPECT_EQ(search_method_from(name_of(method)), method);
  EXPECT_FALSE(search_method_from("kdtree"));
  EXPECT_FALSE(search_method_from(""));
}

}  // namespace
}  // namespace scan
