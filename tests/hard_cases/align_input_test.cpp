// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Broken, missing, repeated and meagre input to alignment, by every method.
#include <gtest/gtest.h>

#include "libscan/core/parallel.h"
#include "tests/align/icp_methods.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

class HardInput : public testing::TestWithParam<IcpMethod> {
 protected:
  IcpOptions options() const { return {.method = GetParam()}; }
};
INSTANTIATE_TEST_SUITE_P(EveryMethod, HardInput, testing::ValuesIn(test::icp_methods),
                         test::method_name);

struct Problem {
  PointCloud source, target;
  Pose guess;
};

Problem bumpy_problem(std::size_t count = 4000) {
  const auto [source, target] = test::split(test::bumpy_surface(count, 1), 2);
  RandomStream random(3, 0, 0);
  return {source, target, test::random_pose(random, 0.03, 0.03)};
}

// H1: NaN and infinity in points and normals of either cloud change nothing but the count.
TEST_P(HardInput, NotANumberIsLeftOutAndCounted) {
  for (const double share : {0.01, 0.5}) {
    Problem dirty = bumpy_problem();
    std::size_t spoilt = 0;
    RandomStream random(4, 0, 0);
    for (PointCloud* cloud : {&dirty.source, &dirty.target})
      for (std::size_t i = 0; i < cloud->size(); ++i) {
        if (random.uniform() >= share) continue;
        Vector3d& victim = random.uniform() < 0.5 ? cloud->points[i] : cloud->normals[i];
        victim[i % 3] = random.uniform() < 0.5 ? std::nan("") : -INFINITY;
        ++spoilt;
      }
    const PointCloud source = subset(dirty.source, finite_points(dirty.source));
    const PointCloud target = subset(dirty.target, finite_points(dirty.target));
    const IcpResult a = icp(dirty.source, dirty.target, dirty.guess, options());
    const IcpResult b = icp(source, target, dirty.guess, options());
    EXPECT_EQ(a.target_from_source.matrix(), b.target_from_source.matrix());
    EXPECT_EQ(a.invalid_points, spoilt);
    EXPECT_EQ(a.iterations, b.iterations);
  }
}

TEST_P(HardInput, NothingButNotANumberIsTooFewPoints) {
  Problem p = bumpy_problem(500);
  for (Vector3d& x : p.source.points) x.x() = std::nan("");
  const IcpResult result = icp(p.source, p.target, p.guess, options());
  EXPECT_EQ(result.stop, Stop::too_few_points);
  EXPECT_EQ(result.target_from_source.matrix(), p.guess.matrix());
}

// H2
TEST_P(HardInput, FewPointsReturnTheGuess) {
  const Problem p = bumpy_problem(500);
  for (const std::uint32_t count : {0u, 1u, 2u, 3u, 5u}) {
    std::vector<std::uint32_t> first;
    for (std::uint32_t i = 0; i < count; ++i) first.push_back(i);
    for (const bool small_source : {true, false}) {
      const IcpResult result =
          icp(small_source ? subset(p.source, first) : p.source,
              small_source ? p.target : subset(p.target, first), p.guess, options());
      EXPECT_EQ(result.stop, Stop::too_few_points);
      EXPECT_EQ(result.target_from_source.matrix(), p.guess.matrix());
      EXPECT_EQ(result.pairs, 0u);
    }
  }
}

// H3
TEST_P(HardInput, CloudsApartHaveNoCorrespondences) {
  const Problem p = bumpy_problem();
  const Pose guess = Eigen::Translation3d(100, 0, 0) * p.guess;
  IcpOptions near = options();
  near.max_pair_distance_m = 0.01;
  const IcpResult result = icp(p.source, p.target, guess, near);
  EXPECT_EQ(result.stop, Stop::no_correspondences);
  EXPECT_EQ(result.target_from_source.matrix(), guess.matrix());
}

// H4
TEST_P(HardInput, TheIterationLimitIsNotConvergence) {
  const Problem p = bumpy_problem();
  IcpOptions few = options();
  few.max_iterations = 2;
  const IcpResult result = icp(p.source, p.target, p.guess, few);
  EXPECT_EQ(result.stop, Stop::iteration_limit);
  EXPECT_EQ(result.iterations, 2);
}

// H13: ten copies of every point are the same cloud; a normal of zero is no normal.
TEST_P(HardInput, RepeatedPointsChangeNothing) {
  const Problem p = bumpy_problem();
  Problem ten = p;
  for (int i = 0; i < 9; ++i) append(ten.source, p.source), append(ten.target, p.target);
  const IcpResult a = icp(p.source, p.target, p.guess, options());
  const IcpResult b = icp(ten.source, ten.target, p.guess, options());
  EXPECT_EQ(b.stop, a.stop);
  // The gate's median is taken from another sample of up to 512 points: a few pairs may differ.
  EXPECT_LT((a.target_from_source.matrix() - b.target_from_source.matrix()).norm(), 1e-3);
}

TEST_P(HardInput, ZeroNormalsAreNotData) {
  Problem p = bumpy_problem();
  for (std::size_t i = 0; i < p.target.size(); i += 2) p.target.normals[i].setZero();
  for (std::size_t i = 0; i < p.source.size(); i += 3) p.source.normals[i].setZero();
  const IcpResult result = icp(p.source, p.target, p.guess, options());
  EXPECT_TRUE(result.target_from_source.matrix().allFinite());
  if (GetParam() == IcpMethod::point_to_plane) {
    EXPECT_EQ(result.stop, Stop::converged);
    EXPECT_LT(result.pairs, p.source.size() * 6 / 10);
  }
  for (Vector3d& n : p.target.normals) n.setZero();
  if (GetParam() == IcpMethod::point_to_plane) {
    EXPECT_EQ(icp(p.source, p.target, p.guess, options()).stop, Stop::no_correspondences);
  }
}

TEST_P(HardInput, AllPointsEqualIsDegenerateNotAFailure) {
  PointCloud one;
  one.points.assign(50, Vector3d(1, 2, 3));
  one.normals.assign(50, Vector3d(0, 0, 1));
  const IcpResult result = icp(one, one, Pose::Identity(), options());
  EXPECT_EQ(result.stop, Stop::degenerate);
  EXPECT_TRUE(result.target_from_source.matrix().allFinite());
}

// H19: identical bytes for any number of threads, again and again.
TEST_P(HardInput, ThreadsDoNotChangeABit) {
  const Problem p = bumpy_problem(10000);
  std::vector<Pose> poses;
  for (int run = 0; run < 3; ++run)
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadLimit limit(threads);
      poses.push_back(icp(p.source, p.target, p.guess, options()).target_from_source);
    }
  for (const Pose& pose : poses) EXPECT_EQ(pose.matrix(), poses[0].matrix());
}

// H23: a matrix that is not a rotation is replaced by the nearest one, and the result says so.
TEST_P(HardInput, AGuessThatIsNoRotationIsProjected) {
  const Problem p = bumpy_problem();
  for (const double shear : {0.0001, 0.05}) {
    Pose sheared = p.guess;
    sheared.linear() *= Eigen::Matrix3d::Identity() +
                        shear * Eigen::Vector3d(1, 0, 0) * Eigen::RowVector3d(0.3, 1, 0);
    const Pose proper = make_pose(nearest_rotation(sheared.linear()), sheared.translation());
    const IcpResult result = icp(p.source, p.target, sheared, options());
    EXPECT_EQ(result.target_from_source.matrix(),
              icp(p.source, p.target, proper, options()).target_from_source.matrix());
    EXPECT_NEAR(result.guess_off_rotation, (sheared.linear() - proper.linear()).norm(), 1e-15);
    EXPECT_GT(result.guess_off_rotation, shear / 2);
  }
  EXPECT_LT(icp(p.source, p.target, p.guess, options()).guess_off_rotation, 1e-14);
}

}  // namespace
}  // namespace scan
