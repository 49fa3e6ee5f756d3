// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/fpfh.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using test::random_direction;

TEST(PairAngles, DoNotDependOnTheOrderOfThePoints) {
  for (std::uint64_t k = 0; k < 1000; ++k) {
    RandomStream random(1, 0, k);
    const Eigen::Vector3d p = random_direction(random), n = random_direction(random);
    const Eigen::Vector3d q = random_direction(random), m = random_direction(random);
    PairAngles forth, back;
    ASSERT_TRUE(pair_angles(p, n, q, m, forth));
    ASSERT_TRUE(pair_angles(q, m, p, n, back));
    EXPECT_NEAR(forth.theta_rad, back.theta_rad, 1e-12);
    EXPECT_NEAR(forth.alpha, back.alpha, 1e-12);
    EXPECT_NEAR(forth.phi, back.phi, 1e-12);
  }
}

// Two points of a unit sphere, an angle g apart: by symmetry the second normal lies in the plane of
// the first and the joining line, so alpha = 0; |phi| = |u . d| = sin(g / 2) and |theta| = g.
TEST(PairAngles, OnASphereAreThoseOfItsChords) {
  for (const double g : {0.01, 0.3, 1.0, 2.0, 3.0}) {
    const Eigen::Vector3d p(0, 0, 1), q(std::sin(g), 0, std::cos(g));
    PairAngles angles;
    ASSERT_TRUE(pair_angles(p, p, q, q, angles));
    EXPECT_NEAR(angles.alpha, 0, 1e-12);
    EXPECT_NEAR(std::abs(angles.phi), std::sin(g / 2), 1e-12);
    EXPECT_NEAR(std::abs(angles.theta_rad), g, 1e-12);
  }
}

TEST(PairAngles, AreNoneWithoutAFrame) {
  PairAngles angles;
  const Eigen::Vector3d p(1, 2, 3), up(0, 0, 1), zero = Eigen::Vector3d::Zero();
  EXPECT_FALSE(pair_angles(p, up, p, up, angles));                               // one point
  EXPECT_FALSE(pair_angles(p, up, p + up, up, angles));                          // along the normal
  EXPECT_FALSE(pair_angles(p, zero, p + Eigen::Vector3d(1, 0, 0), up, angles));  // no normal
}

double sum_of(const Fpfh& histograms, std::size_t which) {
  const auto first = histograms.begin() + std::ptrdiff_t(which * fpfh_bins);
  return std::accumulate(first, first + fpfh_bins, 0.0);
}

// On a plane all three angles are zero: everything is in the middle bin of the three.
TEST(Fpfh, OfAPlaneHasOneBinPerAngle) {
  const PointCloud cloud = test::plane(500, 1);
  for (const Fpfh& histograms : fpfh(cloud, KdTree(cloud.points), 1.5))
    for (std::size_t which = 0; which < 3; ++which)
      EXPECT_NEAR(histograms[which * fpfh_bins + fpfh_bins / 2], 100, 1e-3);
}

TEST(Fpfh, HistogramsSumToAHundredOrAreEmpty) {
  PointCloud cloud = test::bumpy_surface(800, 1);
  cloud.points.emplace_back(50, 0, 0);  // alone
  cloud.normals.emplace_back(0, 0, 1);
  cloud.points.push_back(cloud.points[0]);  // without a normal
  cloud.normals.push_back(Eigen::Vector3d::Zero());
  const std::vector<Fpfh> all = fpfh(cloud, KdTree(cloud.points), 0.3);
  // Eleven additions of floats, each good to 100 * 2^-24.
  for (std::size_t i = 0; i < 800; ++i)
    for (std::size_t which = 0; which < 3; ++which) EXPECT_NEAR(sum_of(all[i], which), 100, 1e-4);
  EXPECT_EQ(all[800], Fpfh{});
  EXPECT_EQ(all[801], Fpfh{});
}

// A motion changes coordinates in the last bits. That moves a pair into another bin only if one of
// its angles lies within some 1e-13 of a border: of 1e5 pairs, none.
TEST(Fpfh, RigidMotionsChangeNothing) {
  const PointCloud cloud = test::bumpy_surface(800, 1);
  RandomStream random(5, 0, 0);
  const PointCloud moved = transformed(test::random_pose(random, 2, 3), cloud);
  const auto before = fpfh(cloud, KdTree(cloud.points), 0.3);
  const auto after = fpfh(moved, KdTree(moved.points), 0.3);
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t k = 0; k < before[i].size(); ++k)
      ASSERT_NEAR(before[i][k], after[i][k], 1e-3) << i << " " << k;
}

// A mirror image has other histograms: alpha changes its sign. Scans are never mirrored.
TEST(Fpfh, MirrorImagesDiffer) {
  const PointCloud cloud = test::bumpy_surface(800, 1);
  PointCloud mirrored = cloud;
  for (Eigen::Vector3d& x : mirrored.points) x.x() = -x.x();
  for (Eigen::Vector3d& n : mirrored.normals) n.x() = -n.x();
  const auto before = fpfh(cloud, KdTree(cloud.points), 0.3);
  const auto after = fpfh(mirrored, KdTree(mirrored.points), 0.3);
  double apart = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t k = 0; k < before[i].size(); ++k)
      apart += std::abs(before[i][k] - after[i][k]) / double(before.size());
  EXPECT_GT(apart, 1);
}

}  // namespace
}  // namespace scan
