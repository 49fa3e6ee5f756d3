// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/overlaps.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

// Square sheets of 1 m, `count` of them in a row, each `step_m` further along x.
struct Row {
  std::vector<PreparedCloud> scans;
  std::vector<Pose> poses;
};

Row sheets(int count, double step_m) {
  Row row;
  for (int k = 0; k < count; ++k) {
    RandomStream random(7, std::uint32_t(k), 0);
    PointCloud cloud;
    for (int i = 0; i < 900; ++i) {
      const double x = random.uniform(), y = random.uniform();
      cloud.points.emplace_back(x, y, 0);
      cloud.normals.emplace_back(0, 0, 1);
    }
    row.scans.push_back(prepare(cloud));
    row.poses.push_back(
        Pose(Eigen::Translation3d(row.scans.back().origin + Vector3d(step_m * k, 0, 0))));
  }
  return row;
}

// By brute force: the larger share of either scan's points that have a point of the other within
// the radius.
double share_within(const Row& row, std::size_t a, std::size_t b, double radius_m) {
  const auto one_way = [&](std::size_t s, std::size_t t) {
    double near = 0;
    for (const Vector3d& x : row.scans[s].points) {
      const Vector3d moved = row.poses[t].inverse() * row.poses[s] * x;
      for (const Vector3d& y : row.scans[t].points)
        if ((moved - y).norm() <= radius_m) {
          ++near;
          break;
        }
    }
    return near / double(row.scans[s].size());
  };
  return std::max(one_way(a, b), one_way(b, a));
}

// Neighbouring cubes reach as far as one side at least and 2 sqrt(3) sides at most; 450 of 900
// samples are off by 3 sqrt(0.25 / 450) = 7 % at most (three sigma).
TEST(FindOverlaps, LiesBetweenBruteForceAtItsLeastAndMostReach) {
  const Row row = sheets(6, 0.3);
  const auto overlaps = find_overlaps(row.scans, row.poses, 0.05, 0);
  ASSERT_FALSE(overlaps.empty());
  for (const Overlap& one : overlaps) {
    EXPECT_LT(one.source, one.target);
    EXPECT_GE(one.share, share_within(row, one.source, one.target, 0.05) - 0.07);
    EXPECT_LE(one.share,
              share_within(row, one.source, one.target, 2 * std::numbers::sqrt3 * 0.05) + 0.07);
  }
  // Sheets three steps apart share 10 cm, four steps apart none.
  EXPECT_EQ(overlaps.size(), 5u + 4u + 3u);
}

TEST(FindOverlaps, LeavesOutSurfacesSeenFromTheOtherSide) {
  Row row = sheets(2, 0);
  EXPECT_EQ(find_overlaps(row.scans, row.poses, 0.05, 0.5).size(), 1u);
  for (Vector3d& normal : row.scans[1].normals) normal = -normal;
  EXPECT_TRUE(find_overlaps(row.scans, row.poses, 0.05, 0.01).empty());
}

// All of 40 scans on one spot: a few partners each, and still one component.
TEST(ChoosePairs, KeepsFewPartnersAndTiesAllThatOverlaps) {
  std::vector<Overlap> overlaps;
  for (std::size_t i = 0; i < 40; ++i)
    for (std::size_t j = i + 1; j < 40; ++j)
      if (i / 20 == j / 20) overlaps.push_back({i, j, 0.9});
  overlaps.push_back({3, 27, 0.1});  // the only bridge between two clusters, last by its share
  const auto chosen = choose_pairs(overlaps, 40, 4);
  EXPECT_LE(chosen.size(), 40u * 4 + 39);
  std::vector<std::size_t> partners(40, 0), component(40);
  std::iota(component.begin(), component.end(), std::size_t{0});
  for (const Overlap& one : chosen) {
    ++partners[one.source], ++partners[one.target];
    const std::size_t from = component[one.source], to = component[one.target];
    for (std::size_t& c : component)
      if (c == from) c = to;
  }
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_GE(partners[i], 4u) << i;
    EXPECT_EQ(component[i], component[0]) << i;
  }
}

}  // namespace
}  // namespace scan
