// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/global.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/align/global_scenes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

double rms_apart_m(const PointCloud& cloud, const Pose& a, const Pose& b) {
  double sum2 = 0;
  for (const Vector3d& x : cloud.points) sum2 += (a * x - b * x).squaredNorm();
  return std::sqrt(sum2 / double(cloud.size()));
}

Pose any_pose(std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  const double angle = 3.1 * random.uniform();
  return test::random_pose(random, angle, 3);
}

// Half a side of the cubes (0.05 m for these clouds) is far inside of what icp then corrects.
void expect_aligned(const PointCloud& source, const PointCloud& target, const Pose& truth,
                    double allowed_m) {
  const GlobalResult result = align_globally(transformed(truth.inverse(), source), target);
  ASSERT_EQ(result.outcome, GlobalOutcome::aligned) << name_of(result.outcome);
  const GlobalHypothesis& best = result.hypotheses.at(0);
  EXPECT_LT(rms_apart_m(transformed(truth.inverse(), source), best.target_from_source, truth),
            allowed_m);
  EXPECT_GE(best.trust, 0.5);
}

TEST(AlignGlobally, ViewsOfOneThingAreBroughtTogether) {
  const PointCloud one = test::lump(12000, 1), other = test::lump(12000, 2);
  expect_aligned(one, other, any_pose(1), 0.025);
  for (const double turn : {0.5, 1.0, 2.0}) {
    const Vector3d there(std::cos(turn), std::sin(turn), 0.3);
    expect_aligned(test::facing(one, {1, 0, 0.3}, 0.1), test::facing(other, there, 0.1),
                   any_pose(2 + std::uint64_t(turn * 2)), 0.025);
  }
  expect_aligned(test::bumpy_surface(8000, 1), test::bumpy_surface(8000, 2), any_pose(9), 0.025);
  expect_aligned(test::furnished_room(16000, 1), test::furnished_room(16000, 2), any_pose(10),
                 0.05);
}

TEST(AlignGlobally, OverlapIsTheShareOfTheSmallerThatMeets) {
  const PointCloud one = test::lump(12000, 1), other = test::lump(12000, 2);
  const GlobalResult result = align_globally(test::facing(one, {1, 0, 0}, 0), other);
  ASSERT_EQ(result.outcome, GlobalOutcome::aligned);
  EXPECT_GT(result.hypotheses[0].overlap, 0.95);
  EXPECT_LT(result.hypotheses[0].conflict, 0.05);
}

TEST(AlignGlobally, DifferentThingsDoNotOverlap) {
  const PointCloud lump = test::lump(8000, 1);
  for (const PointCloud& other :
       {test::bumpy_surface(6000, 1), test::cube_room(8000, 1), test::plane(5000, 1)}) {
    const GlobalResult result = align_globally(transformed(any_pose(3), lump), other);
    EXPECT_EQ(result.outcome, GlobalOutcome::no_overlap);
    for (const GlobalHypothesis& hypothesis : result.hypotheses) EXPECT_LT(hypothesis.trust, 0.5);
  }
}

void expect_ambiguous(const PointCloud& source, const PointCloud& target, std::size_t at_least) {
  const GlobalResult result = align_globally(transformed(any_pose(4), source), target);
  EXPECT_EQ(result.outcome, GlobalOutcome::ambiguous) << name_of(result.outcome);
  ASSERT_GE(result.hypotheses.size(), at_least);
  const double best = result.hypotheses[0].trust * result.hypotheses[0].overlap;
  for (std::size_t k = 0; k < at_least; ++k)
    EXPECT_GT(result.hypotheses[k].trust * result.hypotheses[k].overlap, 0.85 * best) << k;
}

// A cube has 24 rotations, of which 16 fit the list; a box of three different sides has 4.
TEST(AlignGlobally, SymmetricRoomsAreAmbiguous) {
  expect_ambiguous(test::cube_room(8000, 1), test::cube_room(8000, 2), 16);
  expect_ambiguous(test::box(8000, {3, 2, 1}, 1), test::box(8000, {3, 2, 1}, 2), 4);
}

TEST(AlignGlobally, ARoomThatExistsTwiceIsAmbiguous) {
  PointCloud floor_plan = test::furnished_room(16000, 2);
  append(floor_plan,
         transformed(Pose(Eigen::Translation3d(6, 0, 0)), test::furnished_room(16000, 5)));
  expect_ambiguous(test::furnished_room(16000, 1), floor_plan, 2);
}

// 3 x 3 pillars fit into 5 x 5 at 9 places, four ways round.
TEST(AlignGlobally, AGridOfPillarsIsAmbiguous) {
  expect_ambiguous(test::pillars(3, 3, 0, 0, 9000, 1), test::pillars(5, 5, -2, -2, 20000, 2), 9);
}

TEST(AlignGlobally, WhatMaySlideOrTurnIsAmbiguous) {
  expect_ambiguous(test::plane(4000, 1), test::plane(4000, 2), 2);
  expect_ambiguous(test::sphere(4000, 1), test::sphere(4000, 2), 2);
  expect_ambiguous(test::closed_cylinder(5000, 1), test::closed_cylinder(5000, 2), 2);
  expect_ambiguous(test::corridor(6000, 1), test::corridor(6000, 2), 2);
}

// Neither unit nor place matters: lengths from micrometres to megametres, a UTM offset.
TEST(AlignGlobally, HasNoUnitAndNoOrigin) {
  const PointCloud one = test::lump(6000, 1), other = test::lump(6000, 2);
  for (const double scale : {0x1p-20, 0x1p20}) {
    PointCloud a = one, b = other;
    for (Vector3d& x : a.points) x *= scale;
    for (Vector3d& x : b.points) x *= scale;
    Pose truth = any_pose(5);
    truth.translation() *= scale;
    expect_aligned(a, b, truth, 0.03 * scale);
  }
  Pose utm = any_pose(6);
  utm.translation() = Vector3d(5e5, 5.4e6, 100);
  expect_aligned(one, other, utm, 0.03);
}

TEST(AlignGlobally, IsTheSameForAnyNumberOfThreads) {
  const PointCloud a = test::facing(test::lump(8000, 1), {1, 0, 0}, 0.1);
  const PointCloud b = transformed(any_pose(7), test::facing(test::lump(8000, 2), {0, 1, 0}, 0.1));
  std::vector<GlobalResult> results;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    results.push_back(align_globally(a, b));
  }
  for (const GlobalResult& other : results) {
    ASSERT_EQ(other.hypotheses.size(), results[0].hypotheses.size());
    for (std::size_t k = 0; k < other.hypotheses.size(); ++k) {
      EXPECT_EQ(other.hypotheses[k].target_from_source.matrix(),
                results[0].hypotheses[k].target_from_source.matrix());
      EXPECT_EQ(other.hypotheses[k].trust, results[0].hypotheses[k].trust);
    }
  }
}

TEST(AlignGlobally, FeaturesMadeOnceGiveTheSame) {
  const std::vector<PointCloud> clouds = {test::lump(6000, 1),
                                          transformed(any_pose(8), test::lump(6000, 2))};
  const double side_m = feature_side_m(clouds);
  const GlobalResult direct = align_globally(clouds[0], clouds[1]);
  const GlobalResult prepared =
      align_globally(describe(clouds[0], side_m), describe(clouds[1], side_m));
  ASSERT_FALSE(direct.hypotheses.empty());
  EXPECT_EQ(direct.hypotheses[0].target_from_source.matrix(),
            prepared.hypotheses[0].target_from_source.matrix());
}

TEST(AlignGlobally, TooFewPointsAreSaidToBe) {
  PointCloud few = test::lump(20, 1);
  const PointCloud enough = test::lump(3000, 1);
  EXPECT_EQ(align_globally(few, enough).outcome, GlobalOutcome::too_few_points);
  EXPECT_EQ(align_globally(enough, few).outcome, GlobalOutcome::too_few_points);
  EXPECT_EQ(align_globally(PointCloud{}, PointCloud{}).outcome, GlobalOutcome::too_few_points);
  few.points.assign(20, Vector3d(1, 2, 3));
  EXPECT_EQ(align_globally(few, few).outcome, GlobalOutcome::too_few_points);
}

// Collinear, coplanar without extent in one direction, all but a few points the same: an answer,
// whatever it is, without a number that is none.
TEST(AlignGlobally, DegenerateCloudsGetFinitePoses) {
  PointCloud line, dots = test::lump(2000, 1);
  for (int i = 0; i < 2000; ++i) {
    line.points.emplace_back(0.001 * i, 0, 0);
    line.normals.emplace_back(0, 0, 1);
  }
  for (std::size_t i = 10; i < dots.size(); ++i) dots.points[i] = dots.points[0];
  for (const auto& [a, b] :
       {std::pair(line, line), std::pair(line, test::lump(2000, 1)), std::pair(dots, dots)}) {
    const GlobalResult result = align_globally(a, b);
    EXPECT_NE(result.outcome, GlobalOutcome::aligned);
    for (const GlobalHypothesis& hypothesis : result.hypotheses) {
      EXPECT_TRUE(hypothesis.target_from_source.matrix().allFinite());
      EXPECT_TRUE(std::isfinite(hypothesis.trust));
    }
  }
}

TEST(AlignGlobally, RefusesWhatMakesNoSense) {
  const PointCloud cloud = test::lump(2000, 1);
  const ScanFeatures fine = describe(cloud, 0.05), coarse = describe(cloud, 0.1);
  EXPECT_THROW(align_globally(fine, coarse), Error);
  EXPECT_THROW(align_globally(cloud, cloud, {.least_trust = 1.5}), Error);
  EXPECT_THROW(align_globally(cloud, cloud, {.least_trust = NAN}), Error);
  EXPECT_THROW(align_globally(cloud, cloud, {.most_hypotheses = 0}), Error);
  PointCloud bare = cloud;
  bare.normals.clear();
  EXPECT_THROW(align_globally(cloud, bare), Error);
}

}  // namespace
}  // namespace scan
