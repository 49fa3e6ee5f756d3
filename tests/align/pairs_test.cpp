// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pairs.h"

#include <gtest/gtest.h>

#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

TEST(LocalCloud, PosesGoThereAndBack) {
  RandomStream random(1, 0, 0);
  const PointCloud a = test::bumpy_surface(100, 1), b = transformed(test::random_pose(random, 1, 5), a);
  const LocalCloud source = localise(a), target = localise(b);
  const Pose pose = test::random_pose(random, 2, 3);
  const Pose local = local_pose(pose, source, target);
  EXPECT_LT((global_pose(local, source, target).matrix() - pose.matrix()).norm(), 1e-14);
  // The same point either way.
  EXPECT_LT((local * source.points[7] + target.origin - pose * a.points[7]).norm(), 1e-14);
}

TEST(LocalCloud, LeavesOutAndCountsWhatIsNotFinite) {
  PointCloud cloud = test::bumpy_surface(100, 1);
  cloud.points[3].y() = std::nan("");
  cloud.normals[5].x() = INFINITY;
  const LocalCloud local = localise(cloud);
  EXPECT_EQ(local.points.size(), 98u);
  EXPECT_EQ(local.invalid_points, 2u);
}

// Half of the source has no counterpart; its one-sided pairs must not widen the gate.
TEST(PairFinder, GateComesFromPairsThatAreMutual) {
  PointCloud target = test::plane(20000, 2);
  PointCloud source = transformed(make_pose(Eigen::Matrix3d::Identity(), Vector3d(5, 0, 0.02)),
                                  test::plane(20000, 3));
  const LocalCloud s = localise(source), t = localise(target);
  const PairFinder finder(s, t, {});
  const Pose pose = local_pose(Pose::Identity(), s, t);
  const std::vector<Match> matches = finder.find(pose, unlimited_m);
  const Gates gates = finder.tightened({}, pose, matches);
  // The sheets are 0.02 m apart at a spacing of 0.5 / sqrt(200 per m^2) = 0.035 m; one-sided pairs
  // are up to 5 m long.
  EXPECT_GT(gates.distance_m, 0.06);
  EXPECT_LT(gates.distance_m, 0.2);
}

TEST(PairFinder, TrimmingLeavesOutTheWorstShare) {
  const PointCloud cloud = test::bumpy_surface(1000, 4);
  PointCloud noisy = cloud;
  test::add_noise(noisy, 0.01, 5);
  const LocalCloud s = localise(noisy), t = localise(cloud);
  const PairFinder finder(s, t, {.max_pair_distance_m = 1, .trim_fraction = 0.25});
  const Pose pose = local_pose(Pose::Identity(), s, t);
  const std::vector<Match> matches = finder.find(pose, 1);
  const Gates gates = finder.tightened({}, pose, matches);
  EXPECT_EQ(finder.kept(matches, gates).size(), 750u);
}

TEST(PairFinder, NormalsThatDisagreeDoNotPair) {
  const PointCloud cloud = test::plane(500, 6);
  PointCloud flipped = cloud;
  for (Vector3d& n : flipped.normals) n = -n;
  const LocalCloud s = localise(flipped), t = localise(cloud);
  const PairFinder finder(s, t, {});
  for (const Match& match : finder.find(local_pose(Pose::Identity(), s, t), unlimited_m))
    EXPECT_EQ(match.target, no_partner);
}

}  // namespace
}  // namespace scan
