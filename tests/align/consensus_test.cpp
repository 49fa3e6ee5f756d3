// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/consensus.h"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>

#include "libscan/align/rigid_fit.h"
#include "libscan/core/parallel.h"
#include "tests/align/test_clouds.h"

namespace scan {
namespace {

using Eigen::Vector3d;

constexpr double sigma_m = 0.01;

struct Problem {
  Pose truth = Pose::Identity();
  std::vector<Correspondence> all;  // the right ones first
  std::size_t right = 0;
};

Vector3d in_cube(RandomStream& random, double side_m) {
  const double x = random.uniform() - 0.5, y = random.uniform() - 0.5, z = random.uniform() - 0.5;
  return side_m * Vector3d(x, y, z);
}

// Points of a unit cube with a noise of 1 cm; the wrong ones anywhere in a cube of 5 m.
Problem problem(std::size_t count, double outlier_share, std::uint64_t seed) {
  RandomStream random(seed, 9, count);
  Problem p;
  p.truth = test::random_pose(random, 3 * random.uniform(), 2);
  p.right = count - std::size_t(std::lround(outlier_share * double(count)));
  for (std::size_t i = 0; i < count; ++i) {
    Correspondence one;
    one.source = in_cube(random, 1);
    one.target = in_cube(random, 5);
    const double x = random.normal(), y = random.normal(), z = random.normal();
    if (i < p.right) one.target = p.truth * one.source + sigma_m * Vector3d(x, y, z);
    p.all.push_back(one);
  }
  return p;
}

// Three sigma: a right one is within it with probability 0.971 (chi-square of three degrees).
Consensus solve(const Problem& p) {
  return find_consensus(p.all, {.noise_m = 3 * sigma_m, .least_distance_m = 6 * sigma_m});
}

// What least squares over the right ones alone would give, and on top an error that as many chosen
// ones may have: each coordinate of the mean is known to sigma / sqrt(n), and the rotation to
// sigma / (0.28 sqrt n) per axis (0.28 m: rms of a coordinate of the cube); at the cube's corners
// six sigma of the two together, doubled for the choice among neighbouring poses.
double allowed_m(std::size_t right) {
  return 2 * 6 * sigma_m * std::hypot(1.0, 0.87 / 0.28) / std::sqrt(double(right));
}

double corner_error_m(const Pose& a, const Pose& b) {
  double worst = 0;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5})
        worst = std::max(worst, (a * Vector3d(x, y, z) - b * Vector3d(x, y, z)).norm());
  return worst;
}

// Right, or not certain; and certain where as few as eight right ones are left.
TEST(Consensus, SurvivesAnyShareOfOutliersOrSaysNothing) {
  for (const std::size_t count : {100, 500, 1000, 2000, 5000})
    for (const double outliers : {0.0, 0.5, 0.9, 0.95, 0.98, 0.99}) {
      const Problem p = problem(count, outliers, 1);
      const Consensus found = solve(p);
      EXPECT_TRUE(p.right < 8 || !found.poses.empty()) << count << " " << outliers;
      if (found.poses.empty()) continue;
      const ConsensusPose& best = found.poses.front();
      EXPECT_LT(corner_error_m(best.target_from_source, p.truth), allowed_m(p.right))
          << count << " " << outliers;
      EXPECT_GE(found.clique_bound, found.largest_clique);
    }
}

// Wrong ones only: of 100 sets none is called certain. The bound on the expected number of chance
// poses is 1e-3 each, so 0.1 in all.
TEST(Consensus, AmongOutliersAloneIsNone) {
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    EXPECT_TRUE(solve(problem(150 + 5 * seed, 1.0, seed)).poses.empty()) << seed;
}

// Two motions share the correspondences: both are found.
TEST(Consensus, EqualMotionsAreAllListed) {
  Problem a = problem(300, 0.5, 1), b = problem(300, 0.5, 2);
  for (std::size_t i = 0; i < b.right; ++i) a.all.push_back(b.all[i]);
  const Consensus found = solve(a);
  ASSERT_GE(found.poses.size(), 2u);
  const auto error = [&](const Pose& truth) {
    return std::min(corner_error_m(found.poses[0].target_from_source, truth),
                    corner_error_m(found.poses[1].target_from_source, truth));
  };
  EXPECT_LT(error(a.truth), allowed_m(150));
  EXPECT_LT(error(b.truth), allowed_m(150));
}

TEST(Consensus, InliersAreThoseWithinTheNoise) {
  const Problem p = problem(500, 0.8, 4);
  const ConsensusPose best = solve(p).poses.at(0);
  std::vector<std::uint32_t> within;
  for (std::uint32_t i = 0; i < p.all.size(); ++i)
    if ((best.target_from_source * p.all[i].source - p.all[i].target).norm() <= 3 * sigma_m)
      within.push_back(i);
  EXPECT_EQ(best.inliers, within);
}

TEST(Consensus, IsTheSameForAnyNumberOfThreads) {
  const Problem p = problem(1000, 0.95, 4);
  std::vector<Eigen::Matrix4d> poses;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    poses.push_back(solve(p).poses.at(0).target_from_source.matrix());
  }
  EXPECT_EQ(poses[0], poses[1]);
  EXPECT_EQ(poses[0], poses[2]);
}

TEST(Consensus, TooFewCorrespondencesAreNotCertain) {
  const Problem p = problem(100, 0, 1);
  for (const std::size_t count : {0, 1, 2, 3}) {
    const std::span<const Correspondence> few(p.all.data(), count);
    EXPECT_TRUE(find_consensus(few, {.noise_m = 0.03}).poses.empty()) << count;
  }
  const std::vector<Correspondence> same(50, p.all[0]);  // one point fifty times
  EXPECT_TRUE(find_consensus(same, {.noise_m = 0.03, .least_distance_m = 0.06}).poses.empty());
}

// Processor time of this thread alone, so that a busy machine counts for little; the least of five.
double seconds(const Problem& p) {
  const ThreadLimit one(1);
  double least = 1e9;
  for (int k = 0; k < 5; ++k) {
    const std::clock_t start = std::clock();
    solve(p);
    least = std::min(least, double(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

TEST(Consensus, FewOutliersCostNoMoreThanMany) {
  EXPECT_LT(seconds(problem(3000, 0.0, 1)), 1.2 * seconds(problem(3000, 0.9, 1)));
}

}  // namespace
}  // namespace scan
