// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/icp.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;
constexpr IcpMethod both[] = {IcpMethod::point_to_point, IcpMethod::point_to_plane};

double pose_difference(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).norm(); }

// The same points before and after the motion: zero residual at the truth, so it is met to rounding.
TEST(Icp, RecoversANoiseFreeMotionExactly) {
  const PointCloud source = test::bumpy_surface(2000, 1);
  RandomStream random(2, 0, 0);
  const Pose truth = test::random_pose(random, 1, 2);
  const PointCloud target = transformed(truth, source);
  for (const IcpMethod method : both) {
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
TEST(Icp, PointToPlaneJoinsCloudsWithoutCommonPoints) {
  const auto [source, other] = test::split(test::bumpy_surface(20000, 3), 4);
  RandomStream random(5, 0, 0);
  const Pose truth = test::random_pose(random, 0.5, 1);
  const IcpResult result = icp(source, transformed(truth, other), truth * test::random_pose(random, 0.05, 0.05));
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
  const IcpResult result = icp(part(a, -1, 0.3), part(b, -0.3, 1), test::random_pose(random, 0.03, 0.03));
  EXPECT_EQ(result.stop, Stop::converged);
  EXPECT_LT(translation_distance_m(result.target_from_source, Pose::Identity()), 1e-3);
  EXPECT_LT(rotation_distance_rad(result.target_from_source, Pose::Identity()), 1e-3);
  EXPECT_LT(result.inlier_fraction_of_source, 0.5);
}

TEST(Icp, EverySearchGivesTheSamePose) {
  const auto [source, target] = test::split(test::bumpy_surface(4000, 9), 10);
  RandomStream random(11, 0, 0);
  const Pose guess = test::random_pose(random, 0.03, 0.03);
  for (const IcpMethod method : both) {
    const IcpResult first = icp(source, target, guess, {.method = method});
    for (const SearchMethod search : {SearchMethod::octree, SearchMethod::brute_force,
                                      SearchMethod::flann, SearchMethod::pcl_octree}) {
      const IcpResult other = icp(source, target, guess, {.method = method, .search = search});
      EXPECT_EQ(other.target_from_source.matrix(), first.target_from_source.matrix())
          << name_of(search);
    }
  }
}

TEST(Icp, InformationIsThatOfTheResidualsAboutTheTargetsOrigin) {
  PointCloud source = test::bumpy_surface(3000, 12), target = source;
  test::add_noise(source, 0.002, 13);
  const IcpResult result = icp(source, target, Pose::Identity());
  // n n^T summed over the pairs is the lower right block times sigma^2.
  const double trace = result.information.diagonal().tail<3>().sum();
  EXPECT_NEAR(trace * result.rms_m * result.rms_m, double(result.pairs), 1e-6 * double(result.pairs));
  EXPECT_NEAR((result.information - result.information.transpose()).norm(), 0,
              1e-9 * result.information.norm());
  // Moving the target's frame by c maps twists by w -> w, t -> t - w x c... : J^T I J.
  const Vector3d c(10, -20, 5);
  PointCloud source_far = source, target_far = target;
  for (Vector3d& x : source_far.points) x += c;
  for (Vector3d& x : target_far.points) x += c;
  const IcpResult far = icp(source_far, target_far, Pose::Identity());
  Matrix6 j = Matrix6::Identity();
  j.bottomLeftCorner<3, 3>() = -cross_matrix(c);
  EXPECT_LT((far.information - j.transpose() * result.information * j).norm(),
            1e-6 * far.information.norm());
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
  EXPECT_EQ(result.history_rms_m.size(), std::size_t(result.iterations));
  EXPECT_EQ(last.matrix(), result.target_from_source.matrix());
}

TEST(Icp, PointToPlaneWithoutTargetNormalsIsAnError) {
  PointCloud cloud = test::bumpy_surface(100, 16);
  PointCloud bare;
  bare.points = cloud.points;
  EXPECT_THROW(icp(cloud, bare, Pose::Identity()), Error);
  EXPECT_EQ(icp(bare, cloud, Pose::Identity()).stop, Stop::converged);
}

TEST(Icp, RefusesOptionsBeyondTheirLimits) {
  const PointCloud cloud = test::bumpy_surface(100, 17);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.max_pair_distance_m = -1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.trim_fraction = 1}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.max_iterations = 0}), Error);
  EXPECT_THROW(icp(cloud, cloud, Pose::Identity(), {.stop_rotation_rad = std::nan("")}), Error);
  Pose bad = Pose::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_THROW(icp(cloud, cloud, bad), Error);
}

TEST(IcpMethod, NamesGoThereAndBack) {
  for (const IcpMethod method : both) EXPECT_EQ(icp_method_from(name_of(method)), method);
  EXPECT_FALSE(icp_method_from("nearest"));
  EXPECT_EQ(name_of(Stop::no_correspondences), "no correspondences");
}

}  // namespace
}  // namespace scan
