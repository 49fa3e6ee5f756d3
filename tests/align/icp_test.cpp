// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/icp.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/align/icp_methods.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;
using test::icp_methods;

double pose_difference(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).norm();
}

// The same points before and after the motion: zero residual at the truth, so it is met to
// rounding.
TEST(Icp, RecoversANoiseFreeMotionExactly) {
  const PointCloud source = test::bumpy_surface(2000, 1);
  RandomStream random(2, 0, 0);
  const Pose truth = test::random_pose(random, 1, 2);
  const PointCloud target = transformed(truth, source);
  for (const IcpMethod method : icp_methods) {
    // The start is off by less than half a spacing of 0.045 m, so most first partners are right.
    const Pose guess = truth * test::random_pose(random, 0.01, 0.01);
    const IcpResult result = icp(source, target, guess, {.method = method});
    EXPECT_EQ(result.stop, Stop::converged) << name_of(method);
    EXPECT_LT(pose_difference(result.target_from_source, truth), 1e-12);
    EXPECT_LT(result.rms_m, 1e-13);
    EXPECT_TRUE(result.weak_directions.empty());
  }
}

// Halves of one cloud share no point. A partner is off by about half a spacing h along the surface;
// a plane through it is then off by curvature times h^2 / 8, here 3 / m * (0.02 m)^2 / 8 = 0.15 mm,
// which averages over the pairs.
TEST(Icp, JoinsCloudsWithoutCommonPoints) {
  const auto [source, other] = test::split(test::bumpy_surface(20000, 3), 4);
  RandomStream random(5, 0, 0);
  const Pose truth = test::random_pose(random, 0.5, 1);
  const IcpResult result =
      icp(source, transformed(truth, other), truth * test::random_pose(random, 0.05, 0.05));
  EXPECT_EQ(result.stop, Stop::converged);
  EXPECT_LT(translation_distance_m(result.target_from_source, truth), 0.15e-3);
  EXPECT_LT(rotation_distance_rad(result.target_from_source, truth), 0.15e-3);
}

TEST(Icp, PartialOverlapDoesNotPullTheCloudsTogether) {
  PointCloud all = test::bumpy_surface(20000, 6);
  const auto [a, b] = test::split(all, 7);
  const auto part = [](const PointCloud& cloud, double from, double to) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < cloud.size(); ++i)
      if (cloud.points[i].x() >= from && cloud.points[i].x() <= to) kept.push_back(i);
    return subset(cloud, kept);
  };
  RandomStream random(8, 0, 0);
  // 1.3 m of 2 m each: 46 % of the source's points have a counterpart.
  const IcpResult result =
      icp(part(a, -1, 0.3), part(b, -0.3, 1), test::random_pose(random, 0.03, 0.03));
  EXPECT_EQ(result.stop, Stop::converged);
  EXPECT_LT(translation_distance_m(result.target_from_source, Pose::Identity()), 1e-3);
  EXPECT_LT(rotation_distance_rad(result.target_from_source, Pose::Identity()), 1e-3);
  EXPECT_LT(result.inlier_fraction_of_source, 0.5);
  // The same pose, but not to be trusted where more overlap was asked for.
  const IcpResult refused =
      icp(part(a, -1, 0.3), part(b, -0.3, 1), result.target_from_source, {.min_overlap = 0.6});
  EXPECT_EQ(refused.stop, Stop::low_overlap);
  EXPECT_LT(translation_distance_m(refused.target_from_source, Pose::Identity()), 1e-3);
}

TEST(Icp, EverySearchGivesTheSamePose) {
  const auto [source, target] = test::split(test::bumpy_surface(4000, 9), 10);
  RandomStream random(11, 0, 0);
  const Pose guess = test::random_pose(random, 0.03, 0.03);
  for (const IcpMethod method : icp_methods) {
    const IcpResult first = icp(source, target, guess, {.method = method});
    for (const SearchMethod search : {SearchMethod::octree, SearchMethod::brute_force,
                                      SearchMethod::flann, SearchMethod::pcl_octree}) {
      const IcpResult other = icp(source, target, guess, {.method = method, .search = search});
      EXPECT_EQ(other.target_from_source.matrix(), first.target_from_source.matrix())
          << name_of(search);
    }
  }
}

// Seen from another origin it is the same, about the same place.
TEST(Icp, InformationDoesNotDependOnTheOrigin) {
  PointCloud source = test::bumpy_surface(3000, 12), target = source;
  test::add_noise(source, 0.002, 13);
  const IcpResult result = icp(source, target, Pose::Identity());
  EXPECT_EQ(result.information, result.information.transpose());
  const Vector3d c(10, -20, 5);
  for (Vector3d& x : source.points) x += c;
  for (Vector3d& x : target.points) x += c;
  const IcpResult far = icp(source, target, Pose::Identity());
  EXPECT_LT((far.centre - c - result.centre).norm(), 1e-9);
  EXPECT_LT((far.information - result.information).norm(), 1e-6 * result.information.norm());
}

// A start far off makes full steps overshoot.
TEST(Icp, TheObjectiveNeverRises) {
  const auto [source, target] = test::split(test::bumpy_surface(3000, 18), 19);
  RandomStream random(20, 0, 0);
  for (const IcpMethod method : icp_methods) {
    std::size_t compared = 0;
    for (const double off : {0.05, 0.3, 0.6, 1.0, 1.2, 1.5}) {
      const IcpResult result = icp(source, target, test::random_pose(random, off, off),
                                   {.method = method, .max_normal_angle_rad = std::numbers::pi});
      for (std::size_t i = 1; i < result.history.size(); ++i) {
        const IcpState &before = result.history[i - 1], &now = result.history[i];
        EXPECT_LE(now.scale_m, before.scale_m);
        if (now.scale_m != before.scale_m) continue;
        EXPECT_LE(now.objective_m2, before.objective_m2) << name_of(method) << " " << off;
        ++compared;
      }
    }
    EXPECT_GE(compared, 5u) << name_of(method);
  }
}

TEST(Icp, TellsEachIteration) {
  const auto [source, target] = test::split(test::bumpy_surface(2000, 14), 15);
  int calls = 0;
  Pose last;
  const IcpResult result = icp(source, target, make_pose(Eigen::Matrix3d::Identity(), {0.02, 0, 0}),
                               {.on_iteration = [&](int iteration, const Pose& pose) {
                                 EXPECT_EQ(iteration, ++calls);
                                 last = pose;
                               }});
  EXPECT_EQ(calls, result.iterations);
  EXPECT_EQ(result.history.size(), std::size_t(result.iterations));
  EXPECT_EQ(last.matrix(), result.target_from_source.matrix());
}

TEST(Icp, NormalsAreFittedWhereTheCloudsHaveNone) {
  auto [source, target] = test::split(test::bumpy_surface(8000, 16), 17);
  source.normals.clear();
  target.normals.clear();
  RandomStream random(21, 0, 0);
  const Pose guess = test::random_pose(random, 0.03, 0.03);
  for (const IcpMethod method : icp_methods) {
    const IcpResult result = icp(source, target, guess, {.method = method});
    EXPECT_EQ(result.stop, Stop::converged) << name_of(method);
    // Fits over 16 points at a spacing of 0.016 m miss the surface by its curvature times the
    // square of their reach, 3 / m * (0.036 m)^2 / 8 = 0.5 mm; point-to-point is held by the
    // points.
    const double limit_m = method == IcpMethod::point_to_point ? 8e-3 : 0.5e-3;
    EXPECT_LT(translation_distance_m(result.target_from_source, Pose::Identity()), limit_m);
  }
}

// Prepared once, used twice, in either role.
TEST(Icp, PreparedCloudsGiveTheSame) {
  const auto [source, target] = test::split(test::bumpy_surface(4000, 22), 23);
  const PreparedCloud a = prepare(source), b = prepare(target);
  const Pose guess = Pose(Eigen::Translation3d(0.01, 0.02, 0));
  const Pose once = icp(a, b, guess).target_from_source;
  icp(b, a, guess);
  EXPECT_EQ(icp(a, b, guess).target_from_source.matrix(), once.matrix());
  EXPECT_EQ(icp(source, target, guess).target_from_source.matrix(), once.matrix());
}

TEST(Icp, RefusesOptionsBeyondTheirLimits) {
  const PointCloud cloud = test::bumpy_surface(100, 17);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.max_pair_distance_m = -1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.trim_fraction = 1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.max_iterations = 0}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.min_overlap = 1.1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.stop_rotation_rad = std::nan("")}), Error);
  Pose bad = Pose::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_THROW(icp(cloud, cloud, bad), Error);
}

TEST(IcpMethod, NamesGoThereAndBack) {
  for (const IcpMethod method : icp_methods) EXPECT_EQ(icp_method_from(name_of(method)), method);
  EXPECT_FALSE(icp_method_from("nearest"));
  EXPECT_EQ(name_of(Stop::no_correspondences), "no correspondences");
}

}  // namespace
}  // namespace scan
