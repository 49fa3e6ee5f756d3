// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/multiview.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/align/open_views.h"
#include "tests/align/turntable.h"

namespace scan {
namespace {

using Eigen::Vector3d;

// Largest distance that a pose puts one of its scan's points from where the truth puts it.
double worst_m(const PointCloud& cloud, const Pose& pose, const Pose& truth) {
  double worst = 0;
  for (const Vector3d& x : cloud.points) worst = std::max(worst, (pose * x - truth * x).norm());
  return worst;
}

// Normals from 16 neighbours at a spacing of 0.04 m bend each residual by up to about 1 mm of
// curvature error, of one sign; noise of 1 mm adds 1 mm / sqrt(pairs). The loop must not collect
// it: every scan within 2 mm, though neighbouring pairs alone could add up.
TEST(AlignScans, ATurntableClosesItsLoop) {
  const test::Turntable t = test::turntable(8, 0.001);
  const MultiviewResult result = align_scans(t.clouds, t.guesses);
  EXPECT_EQ(result.stop, Stop::converged);
  EXPECT_GE(result.pairs_used, 8u);
  EXPECT_EQ(result.scans[0].world_from_scan.matrix(), t.guesses[0].matrix());
  for (std::size_t i = 0; i < t.clouds.size(); ++i)
    EXPECT_LT(worst_m(t.clouds[i], result.scans[i].world_from_scan, t.truth[i]), 2e-3) << i;
}

TEST(AlignScans, AScanThatOverlapsNothingKeepsItsGuess) {
  test::Turntable t = test::turntable(5, 0);
  t.guesses[2] = Eigen::Translation3d(50, 0, 0) * t.guesses[2];
  const MultiviewResult result = align_scans(t.clouds, t.guesses);
  EXPECT_EQ(result.scans[1].stop, Stop::converged);
  EXPECT_EQ(result.scans[2].stop, Stop::no_correspondences);
  EXPECT_EQ(result.scans[2].world_from_scan.matrix(), t.guesses[2].matrix());
  EXPECT_EQ(result.stop, Stop::no_correspondences);
}

TEST(AlignScans, AnotherAnchorGivesTheSameRelativePoses) {
  const test::Turntable t = test::turntable(6, 0);
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
  const test::Turntable t = test::turntable(5, 0);
  const Vector3d offset(5e5, 5.4e6, 0);
  std::vector<Pose> far = t.guesses;
  for (Pose& pose : far) pose.translation() += offset;
  const MultiviewResult a = align_scans(t.clouds, t.guesses);
  const MultiviewResult b = align_scans(t.clouds, far);
  EXPECT_EQ(a.rounds, b.rounds);
  for (std::size_t i = 0; i < 5; ++i) {  // coordinates there are rounded to 1e-9 m
    EXPECT_LT((b.scans[i].world_from_scan.translation() - offset -
               a.scans[i].world_from_scan.translation())
                  .norm(),
              1e-8);
    EXPECT_LT((b.scans[i].world_from_scan.linear() - a.scans[i].world_from_scan.linear()).norm(),
              1e-8);
  }
}

TEST(AlignScans, ScansOfOnePlaneAreDegenerateAndStayWhereTheyWere) {
  PointCloud a = test::plane(3000, 1), b = test::plane(3000, 2);
  const Pose guess =
      make_pose(Eigen::AngleAxisd(0.02, Vector3d::UnitX()).toRotationMatrix(), {0.3, 0.1, 0.05});
  const MultiviewResult result =
      align_scans(std::vector{a, b}, std::vector<Pose>{Pose::Identity(), guess});
  EXPECT_EQ(result.scans[1].stop, Stop::degenerate);
  EXPECT_EQ(result.scans[1].weak_directions.size(), 3u);
  const Vector3d moved = result.scans[1].world_from_scan.translation();
  EXPECT_NEAR(moved.z(), 0, 1e-6);
  EXPECT_LT((moved.head<2>() - Eigen::Vector2d(0.3, 0.1)).norm(), 5e-3);
}

TEST(AlignScans, ThreadsDoNotChangeABit) {
  const test::Turntable t = test::turntable(6, 0.001);
  std::vector<MultiviewResult> results;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    results.push_back(align_scans(t.clouds, t.guesses));
  }
  for (std::size_t i = 0; i < 6; ++i)
    for (const MultiviewResult& result : results)
      EXPECT_EQ(result.scans[i].world_from_scan.matrix(),
                results[0].scans[i].world_from_scan.matrix());
}

TEST(AlignScans, ReportsProgress) {
  const test::Turntable t = test::turntable(5, 0);
  double pairs = 0, refined = 0;
  align_scans(t.clouds, t.guesses, {}, [&](std::string_view step, double share) {
    (step == "pairs" ? pairs : refined) = share;
  });
  EXPECT_EQ(pairs, 1);
  EXPECT_EQ(refined, 1);
}

TEST(AlignScans, SmallAndEmptyInputsAreAnswered) {
  EXPECT_TRUE(align_scans({}, {}).scans.empty());
  const PointCloud cloud = test::lump(500, 1);
  EXPECT_EQ(align_scans(std::vector{cloud}, std::vector{Pose::Identity()}).stop, Stop::converged);
  const MultiviewResult result = align_scans(std::vector{cloud, PointCloud{}},
                                             std::vector<Pose>{Pose::Identity(), Pose::Identity()});
  EXPECT_EQ(result.scans[1].stop, Stop::too_few_points);
  EXPECT_THROW(align_scans(std::vector{cloud}, {}), Error);
  EXPECT_THROW(align_scans(std::vector{cloud}, std::vector{Pose::Identity()}, {.anchor = 1}),
               Error);
  EXPECT_THROW(align_scans(std::vector{cloud}, std::vector{Pose::Identity()}, {.max_rounds = 0}),
               Error);
}

struct Stopped {};

TEST(AlignScans, AnInterruptedCallGoesOnFromItsPairs) {
  const test::Turntable t = test::turntable(6, 0.001);
  const ThreadLimit limit(1);
  std::size_t all = 0, more = 0, reports = 0;
  MultiviewOptions options{.on_edge = [&](const ScanEdge&) { ++all; }};
  const MultiviewResult whole = align_scans(t.clouds, t.guesses, options);
  std::vector<ScanEdge> kept;
  options.on_edge = [&](const ScanEdge& edge) { kept.push_back(edge); };
  const Progress stop = [&](std::string_view, double) {
    if (++reports == 5) throw Stopped{};
  };
  EXPECT_THROW(align_scans(t.clouds, t.guesses, options, stop), Stopped);
  EXPECT_EQ(kept.size(), 5u);
  options.known_edges = kept;
  options.on_edge = [&](const ScanEdge&) { ++more; };
  const MultiviewResult rest = align_scans(t.clouds, t.guesses, options);
  EXPECT_EQ(more + 5, all);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(rest.scans[i].world_from_scan.matrix(), whole.scans[i].world_from_scan.matrix());
}

// The pair alone cannot see it, the loops do: scan 3's guess is so far off that its pairs settle
// elsewhere, or not at all. Two ends of a pair may each be off by the 2 mm of a turntable's scan.
// Along a motion that the data leave open an edge has the pose of its guess, which counts with 0.05
// rad and 0.05 of the size of 1 m: within the limit of 22.458 of its chi-square, points 2 m away
// from the middle are off by at most sqrt(22.458) 0.05 sqrt(1 + 2^2) m = 0.53 m.
TEST(AlignScans, WrongPairsAreNamedAndDoNoHarm) {
  test::Turntable t = test::turntable(8, 0.001);
  RandomStream random(77, 0, 0);
  t.guesses[3] = test::random_pose(random, 0.6, 0.3) * t.guesses[3];
  const MultiviewResult result = align_scans(t.clouds, t.guesses);
  for (const ScanEdge& edge : result.edges) {
    if (!edge.accepted) continue;
    const Pose truth = t.truth[edge.target].inverse() * t.truth[edge.source];
    EXPECT_LT(worst_m(t.clouds[edge.source], edge.target_from_source, truth),
              edge.stop == Stop::degenerate ? 0.53 : 4e-3)
        << edge.source << " " << edge.target;
  }
  for (std::size_t i = 0; i < 8; ++i)
    if (i != 3) {
      EXPECT_LT(worst_m(t.clouds[i], result.scans[i].world_from_scan, t.truth[i]), 2e-3);
    }
  if (result.scans[3].stop == Stop::converged) {
    EXPECT_LT(worst_m(t.clouds[3], result.scans[3].world_from_scan, t.truth[3]), 2e-3);
  }
}

// Chi-square with six degrees of freedom over six varies by 1 / 3, and so does at most the mean
// over the scans of one set, which share the anchor's errors: the mean over 60 sets has a standard
// error of at most sqrt(1 / 3 / 60) = 0.075, of sets as measured 0.055. Covariances a quarter too
// large or too small put it to 0.8 or 1.33, more than 3.6 of the latter away from one; 0.19 off one
// is allowed, 2.5 of the former.
class CovariancesOf : public testing::TestWithParam<test::ScannerNoise> {};
INSTANTIATE_TEST_SUITE_P(Noises, CovariancesOf,
                         testing::Values(test::ScannerNoise::lidar, test::ScannerNoise::stereo,
                                         test::ScannerNoise::correlated),
                         [](const auto& noise) { return std::string(test::name_of(noise.param)); });

TEST_P(CovariancesOf, ManyScansTellTheErrorsThatThereAre) {
  std::vector<double> errors2(60);
  parallel_for(
      errors2.size(),
      [&](std::size_t k) {
        const test::SimulatedViews views = test::simulated_views(GetParam(), 80, k + 1);
        const MultiviewResult result = align_scans(views.clouds, views.guesses);
        for (std::size_t i = 1; i < 4; ++i)
          errors2[k] += test::normalised_error2(result, views.truth, i).value() / 18;
      },
      1);
  EXPECT_NEAR(std::accumulate(errors2.begin(), errors2.end(), 0.0) / 60, 1, 0.19);
}

TEST(AlignScans, IdenticalScansComeToLieOnEachOther) {
  const PointCloud cloud = test::lump(4000, 5);
  std::vector<Pose> guesses;
  for (std::uint64_t i = 0; i < 6; ++i) {
    RandomStream random(80 + i, 0, 0);
    guesses.push_back(i == 0 ? Pose::Identity() : test::random_pose(random, 0.05, 0.04));
  }
  const MultiviewResult result = align_scans(std::vector<PointCloud>(6, cloud), guesses);
  EXPECT_EQ(result.stop, Stop::converged);
  for (const ScanPose& scan : result.scans)  // there is no noise: to the iteration's end, 1e-6
    EXPECT_LT(worst_m(cloud, scan.world_from_scan, Pose::Identity()), 1e-5);
}

TEST(AlignScans, WhereNoPairOverlapsAllKeepTheirGuess) {
  std::vector<PointCloud> clouds;
  std::vector<Pose> guesses;
  for (std::uint64_t i = 0; i < 6; ++i) {
    clouds.push_back(test::lump(500, 90 + i));
    guesses.push_back(Pose(Eigen::Translation3d(10.0 * double(i), 0, 0)));
  }
  const MultiviewResult result = align_scans(clouds, guesses);
  EXPECT_EQ(result.stop, Stop::no_correspondences);
  EXPECT_TRUE(result.edges.empty());
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(result.scans[i].stop, Stop::no_correspondences);
    EXPECT_EQ(result.scans[i].world_from_scan.matrix(), guesses[i].matrix());
    EXPECT_FALSE(result.scans[i].covariance);
  }
}

TEST(AlignScans, GuessesThatAreNoRotationsAreRefused) {
  const PointCloud cloud = test::lump(500, 1);
  const auto with = [&](const Eigen::Matrix3d& matrix) {
    std::vector<Pose> guesses(2, Pose::Identity());
    guesses[1].linear() = matrix;
    return align_scans(std::vector{cloud, cloud}, guesses);
  };
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(0, 1) = 8e-7;  // 4e-7 from the nearest rotation: repaired
  EXPECT_LT((with(matrix).scans[1].world_from_scan.linear() - Eigen::Matrix3d::Identity()).norm(),
            1e-5);
  matrix(0, 1) = 8e-6;
  EXPECT_THROW(with(matrix), Error);
  EXPECT_THROW(with(Eigen::Vector3d(1, 1, -1).asDiagonal()), Error);
}

}  // namespace
}  // namespace scan
