// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/multiview.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

// A lump without symmetry: a unit sphere whose radius varies with the direction.
PointCloud lump(std::size_t count, std::uint64_t seed) {
  PointCloud cloud = test::sphere(count, seed);
  for (Vector3d& x : cloud.points)
    x *= 1 + 0.15 * std::sin(3 * x.x() + 1) * std::cos(2 * x.y()) + 0.1 * x.z() * x.x() +
         0.05 * std::sin(5 * x.z());
  test::estimate_normals(cloud, [](const Vector3d& x) { return x; });
  return cloud;
}

struct Turntable {
  std::vector<PointCloud> clouds;
  std::vector<Pose> truth, guesses;
};

// `count` views around z, each of the half that faces it, with points of its own.
Turntable turntable(int count, double sigma_m) {
  Turntable t;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    PointCloud all = lump(6000, 100 + std::uint64_t(i));
    const Vector3d view(std::cos(angle), std::sin(angle), 0.3);
    std::vector<std::uint32_t> seen;
    for (std::uint32_t k = 0; k < all.size(); ++k)
      if (all.normals[k].dot(view) > 0.3) seen.push_back(k);
    PointCloud cloud = subset(all, seen);
    test::add_noise(cloud, sigma_m, 200 + std::uint64_t(i));
    RandomStream random(300 + std::uint64_t(i), 0, 0);
    const Pose pose = test::random_pose(random, 2, 3);
    t.truth.push_back(pose);
    t.clouds.push_back(transformed(pose.inverse(), cloud));
    t.guesses.push_back(i == 0 ? pose : test::random_pose(random, 0.05, 0.04) * pose);
  }
  return t;
}

// Largest distance that a pose puts one of its scan's points from where the truth puts it.
double worst_m(const PointCloud& cloud, const Pose& pose, const Pose& truth) {
  double worst = 0;
  for (const Vector3d& x : cloud.points) worst = std::max(worst, (pose * x - truth * x).norm());
  return worst;
}

// Normals from 16 neighbours at a spacing of 0.04 m bend each residual by up to about 1 mm of
// curvature error, of one sign; noise of 1 mm adds 1 mm / sqrt(pairs). The loop must not collect it:
// every scan within 2 mm, though neighbouring pairs alone could add up.
TEST(AlignScans, ATurntableClosesItsLoop) {
  const Turntable t = turntable(8, 0.001);
  const MultiviewResult result = align_scans(t.clouds, t.guesses);
  EXPECT_EQ(result.stop, Stop::converged);
  EXPECT_GE(result.pairs_used, 8u);
  EXPECT_EQ(result.scans[0].world_from_scan.matrix(), t.guesses[0].matrix());
  for (std::size_t i = 0; i < t.clouds.size(); ++i)
    EXPECT_LT(worst_m(t.clouds[i], result.scans[i].world_from_scan, t.truth[i]), 2e-3) << i;
}

TEST(AlignScans, AScanThatOverlapsNothingKeepsItsGuess) {
  Turntable t = turntable(3, 0);
  t.guesses[2] = Eigen::Translation3d(50, 0, 0) * t.guesses[2];
  const MultiviewResult result = align_scans(t.clouds, t.guesses);
  EXPECT_EQ(result.scans[1].stop, Stop::converged);
  EXPECT_EQ(result.scans[2].stop, Stop::no_correspondences);
  EXPECT_EQ(result.scans[2].world_from_scan.matrix(), t.guesses[2].matrix());
  EXPECT_EQ(result.stop, Stop::no_correspondences);
}

TEST(AlignScans, AnotherAnchorGivesTheSameRelativePoses) {
  const Turntable t = turntable(4, 0);
  const MultiviewResult a = align_scans(t.clouds, t.guesses);
  const MultiviewResult b = align_scans(t.clouds, t.guesses, {.anchor = 2});
  EXPECT_EQ(b.scans[2].world_from_scan.matrix(), t.guesses[2].matrix());
  const Pose a_13 = a.scans[1].world_from_scan.inverse() * a.scans[3].world_from_scan;
  const Pose b_13 = b.scans[1].world_from_scan.inverse() * b.scans[3].world_from_scan;
  // Both end at a minimum of the same sum, from different starts: within a tenth of its error.
  EXPECT_LT(translation_distance_m(a_13, b_13), 2e-4);
  EXPECT_LT(rotation_distance_rad(a_13, b_13), 2e-4);
}

TEST(AlignScans, FarFromTheOriginItIsTheSame) {
  const Turntable t = turntable(3, 0);
  const Vector3d offset(5e5, 5.4e6, 0);
  std::vector<Pose> far = t.guesses;
  for (Pose& pose : far) pose.translation() += offset;
  const MultiviewResult a = align_scans(t.clouds, t.guesses);
  const MultiviewResult b = align_scans(t.clouds, far);
  EXPECT_EQ(a.rounds, b.rounds);
  for (std::size_t i = 0; i < 3; ++i) {  // coordinates there are rounded to 1e-9 m
    EXPECT_LT((b.scans[i].world_from_scan.translation() - offset -
               a.scans[i].world_from_scan.translation()).norm(), 1e-8);
    EXPECT_LT((b.scans[i].world_from_scan.linear() - a.scans[i].world_from_scan.linear()).norm(),
              1e-8);
  }
}

TEST(AlignScans, ScansOfOnePlaneAreDegenerateAndStayWhereTheyWere) {
  PointCloud a = test::plane(3000, 1), b = test::plane(3000, 2);
  const Pose guess = make_pose(Eigen::AngleAxisd(0.02, Vector3d::UnitX()).toRotationMatrix(), {0.3, 0.1, 0.05});
  const MultiviewResult result =
      align_scans(std::vector{a, b}, std::vector<Pose>{Pose::Identity(), guess});
  EXPECT_EQ(result.scans[1].stop, Stop::degenerate);
  EXPECT_EQ(result.scans[1].weak_directions.size(), 3u);
  const Vector3d moved = result.scans[1].world_from_scan.translation();
  EXPECT_NEAR(moved.z(), 0, 1e-6);
  EXPECT_LT((moved.head<2>() - Eigen::Vector2d(0.3, 0.1)).norm(), 5e-3);
}

TEST(AlignScans, ThreadsDoNotChangeABit) {
  const Turntable t = turntable(4, 0.001);
  std::vector<MultiviewResult> results;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    results.push_back(align_scans(t.clouds, t.guesses));
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (const MultiviewResult& result : results)
      EXPECT_EQ(result.scans[i].world_from_scan.matrix(), results[0].scans[i].world_from_scan.matrix());
}

TEST(AlignScans, ReportsProgress) {
  const Turntable t = turntable(3, 0);
  double placed = 0, refined = 0;
  align_scans(t.clouds, t.guesses, {}, [&](std::string_view step, double share) {
    (step == "place" ? placed : refined) = share;
  });
  EXPECT_EQ(placed, 1);
  EXPECT_GT(refined, 0);
}

TEST(AlignScans, SmallAndEmptyInputsAreAnswered) {
  EXPECT_TRUE(align_scans({}, {}).scans.empty());
  const PointCloud cloud = lump(500, 1);
  EXPECT_EQ(align_scans(std::vector{cloud}, std::vector{Pose::Identity()}).stop, Stop::converged);
  const MultiviewResult result = align_scans(std::vector{cloud, PointCloud{}},
                                             std::vector<Pose>{Pose::Identity(), Pose::Identity()});
  EXPECT_EQ(result.scans[1].stop, Stop::too_few_points);
  EXPECT_THROW(align_scans(std::vector{cloud}, {}), Error);
  EXPECT_THROW(align_scans(std::vector{cloud}, std::vector{Pose::Identity()}, {.anchor = 1}), Error);
  EXPECT_THROW(align_scans(std::vector{cloud}, std::vector{Pose::Identity()}, {.max_rounds = 0}), Error);
}

}  // namespace
}  // namespace scan
