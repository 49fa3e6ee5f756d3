// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/exploration.h"

#include <gtest/gtest.h>

#include "libscan/align/pose_judge.h"
#include "libscan/core/parallel.h"
#include "tests/align/global_scenes.h"

namespace scan {
namespace {

double apart_m(const PointCloud& cloud, const Pose& a, const Pose& b) {
  double worst = 0;
  for (const Eigen::Vector3d& x : cloud.points) worst = std::max(worst, (a * x - b * x).norm());
  return worst;
}

bool finds(const PointCloud& a, const PointCloud& b, const Pose& truth) {
  const double side_m = 0.06;
  const ScanFeatures source = describe(transformed(truth.inverse(), a), side_m);
  const ScanFeatures target = describe(b, side_m);
  const PoseJudge judge(source, target);
  for (const Pose& pose : explore_rotations(source, target, 64))
    if (apart_m(source.cloud, judge.settled(pose), truth) < side_m) return true;
  return false;
}

// Views of one lump 0 and 60 degrees apart, which share all and 70 % of what they see.
TEST(Exploration, FindsTheRotationWithoutFeatures) {
  const PointCloud one = test::lump(12000, 1), other = test::lump(12000, 2);
  for (std::uint64_t k = 0; k < 3; ++k) {
    RandomStream random(4, 0, k);
    const Pose truth = test::random_pose(random, 3 * random.uniform(), 2);
    EXPECT_TRUE(
        finds(test::facing(one, {1, 0, 0.3}, 0.1), test::facing(other, {1, 0, 0.3}, 0.1), truth));
    EXPECT_TRUE(finds(test::facing(one, {1, 0, 0.3}, 0.1),
                      test::facing(other, {0.5, 0.87, 0.3}, 0.1), truth));
  }
}

TEST(Exploration, GivesNoMoreThanIsAskedAndTheSameForAnyNumberOfThreads) {
  const ScanFeatures a = describe(test::lump(3000, 1), 0.1), b = describe(test::lump(3000, 2), 0.1);
  std::vector<std::vector<Pose>> all;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    all.push_back(explore_rotations(a, b, 5));
    ASSERT_EQ(all.back().size(), 5u);
  }
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(all[0][k].matrix(), all[1][k].matrix());
}

}  // namespace
}  // namespace scan
