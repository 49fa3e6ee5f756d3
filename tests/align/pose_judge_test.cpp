// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pose_judge.h"

#include <gtest/gtest.h>

#include "tests/align/global_scenes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

double apart_m(const PointCloud& cloud, const Pose& a, const Pose& b) {
  double worst = 0;
  for (const Vector3d& x : cloud.points) worst = std::max(worst, (a * x - b * x).norm());
  return worst;
}

TEST(PoseJudge, TheSameCloudMeetsItselfWhole) {
  const ScanFeatures lump = describe(test::lump(8000, 1), 0.06);
  const PoseVerdict verdict = PoseJudge(lump, lump).judge(Pose::Identity());
  EXPECT_EQ(verdict.overlap, 1);
  EXPECT_EQ(verdict.conflict, 0);
  EXPECT_EQ(verdict.rms_m, 0);
  EXPECT_GT(verdict.trust, 0.98);  // 3,000 points against the 20 of doubt
}

TEST(PoseJudge, CloudsApartHaveNothingInCommon) {
  const ScanFeatures lump = describe(test::lump(8000, 1), 0.06);
  const PoseVerdict verdict = PoseJudge(lump, lump).judge(Pose(Eigen::Translation3d(10, 0, 0)));
  EXPECT_EQ(verdict.overlap, 0);
  EXPECT_EQ(verdict.trust, 0);
}

// Half of a plane on a whole one: the half lies wholly on it, from either side of the question.
TEST(PoseJudge, OverlapIsThatOfTheSmaller) {
  const PointCloud whole = test::plane(6000, 1);
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < whole.size(); ++i)
    if (whole.points[i].x() < 0) left.push_back(i);
  const ScanFeatures a = describe(whole, 0.2), b = describe(subset(whole, left), 0.2);
  EXPECT_GT(PoseJudge(a, b).judge(Pose::Identity()).overlap, 0.99);
  EXPECT_GT(PoseJudge(b, a).judge(Pose::Identity()).overlap, 0.99);
}

// A shift across the planes by half of what is allowed leaves residuals of that size: with the
// tolerance e = 0.35 sides the trust is 1 - 3 (e / 2)^2 / e^2 = 1/4.
TEST(PoseJudge, TrustFallsWithTheSquareOfTheResidual) {
  const ScanFeatures plane = describe(test::plane(20000, 1), 0.2);
  const double shift_m = 0.175 * 0.2;
  const PoseVerdict verdict =
      PoseJudge(plane, plane).judge(Pose(Eigen::Translation3d(0, 0, shift_m)));
  EXPECT_NEAR(verdict.rms_m, shift_m, 1e-12);
  EXPECT_NEAR(verdict.trust, 0.25, 0.25 * 0.02);  // less the share of the doubt
}

// The back of a sheet is not its front.
TEST(PoseJudge, NormalsThatDisagreeContradict) {
  const PointCloud plane = test::plane(6000, 1);
  const ScanFeatures a = describe(plane, 0.2), b = describe(test::turned_inside_out(plane), 0.2);
  const PoseVerdict verdict = PoseJudge(a, b).judge(Pose::Identity());
  EXPECT_EQ(verdict.overlap, 0);
  EXPECT_EQ(verdict.trust, 0);
}

// A sheet 1 m in front of a wall, from 5 m away: the wall's scanner looked through where the sheet
// is said to be. Behind the wall it would be hidden, and without a viewpoint nothing is known.
TEST(PoseJudge, WhatAScannerSawThroughCannotBe) {
  const PointCloud wall = test::plane(6000, 1);
  PointCloud sheet = test::plane(2000, 2);
  for (Vector3d& x : sheet.points) x *= 0.2;
  const ScanFeatures seen = describe(wall, 0.2, Vector3d(0, 0, 5)), blind = describe(wall, 0.2);
  // A part of it lies on the wall, so that there is something to be contradicted.
  PointCloud both = sheet;
  append(both, transformed(Pose(Eigen::Translation3d(0, 0, 1)), sheet));
  const ScanFeatures in_front = describe(both, 0.2);
  for (Vector3d& x : both.points) x.z() = -x.z();
  const ScanFeatures behind = describe(both, 0.2);
  EXPECT_GT(PoseJudge(in_front, seen).judge(Pose::Identity()).conflict, 0.1);
  EXPECT_GT(PoseJudge(seen, in_front).judge(Pose::Identity()).conflict, 0.1);
  EXPECT_LT(PoseJudge(behind, seen).judge(Pose::Identity()).conflict, 0.02);
  EXPECT_LT(PoseJudge(in_front, blind).judge(Pose::Identity()).conflict, 0.02);
}

// From 4 degrees and a side off, back to a tenth of a side (halves of one sampling, each cube's
// mean is off by some 0.3 sides / sqrt of its points; 600 pairs average that out).
TEST(PoseJudge, SettlesWhereTheSurfacesLieOnEachOther) {
  const double side_m = 0.06;
  const auto [a, b] = test::split(test::lump(30000, 1), 2);
  const ScanFeatures source = describe(a, side_m), target = describe(b, side_m);
  const PoseJudge judge(source, target);
  for (std::uint64_t k = 0; k < 10; ++k) {
    RandomStream random(3, 0, k);
    const Pose start = test::random_pose(random, 0.07, side_m);
    EXPECT_LT(apart_m(a, judge.settled(start), Pose::Identity()), 0.1 * side_m) << k;
  }
}

TEST(PoseJudge, WithoutPairsThePoseStays) {
  const ScanFeatures lump = describe(test::lump(3000, 1), 0.1);
  const PoseJudge judge(lump, lump);
  const Pose far(Eigen::Translation3d(10, 0, 0));
  EXPECT_EQ(judge.settled(far).matrix(), far.matrix());
  EXPECT_TRUE(judge.slid(far, 0.1).empty());
}

// On a plane the three motions of least resistance are those within it, and the points move as far
// as was asked; nothing brings them back.
TEST(PoseJudge, SlidesAlongWhatThePlaneLeavesFree) {
  const PointCloud plane = test::plane(6000, 1);
  const ScanFeatures features = describe(plane, 0.2);
  const PoseJudge judge(features, features);
  const auto poses = judge.slid(Pose::Identity(), 0.5);
  ASSERT_EQ(poses.size(), 6u);
  for (const Pose& pose : poses) {
    double sum2 = 0;
    for (const Vector3d& x : plane.points) {
      EXPECT_NEAR((pose * x).z(), 0, 1e-6);
      sum2 += (pose * x - x).squaredNorm() / double(plane.size());
    }
    EXPECT_NEAR(std::sqrt(sum2), 0.5, 0.05);  // a turn by 0.1 rad leaves its tangent by 5 mm
    EXPECT_GT(apart_m(plane, judge.settled(pose), Pose::Identity()), 0.3);
  }
}

}  // namespace
}  // namespace scan
