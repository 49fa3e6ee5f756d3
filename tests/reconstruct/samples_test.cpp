// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/samples.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <numeric>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

TEST(Samples, AreasAddUpToTheSurface) {
  const Samples samples = prepare_samples(sphere_cloud(20000));
  const double total = std::accumulate(samples.area.begin(), samples.area.end(), 0.0);
  const double true_area = 4 * std::numbers::pi / (samples.box.side_m * samples.box.side_m);
  // pi r_k^2 / k has mean 1 and spread 1/sqrt(k) = 0.32 about the true area per point; the median
  // of ten neighbours is below the mean of this skewed law (by about 1/(3k)) and neighbours share
  // most of their spread: 10 % bounds the bias, the mean over 20,000 points has no noise beside it.
  EXPECT_NEAR(total / true_area, 1, 0.1);
}

TEST(Samples, MergeEqualPointsAndCountBadOnes) {
  PointCloud cloud = sphere_cloud(100);
  append(cloud, sphere_cloud(100));  // each point twice
  cloud.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  cloud.normals[5].setZero();
  const Samples samples = prepare_samples(cloud);
  EXPECT_EQ(samples.invalid_points, 2u);
  EXPECT_EQ(samples.points.size(), 100u);  // 3 and 5 are there once
}

TEST(Samples, DropEqualPointsWithOpposedNormals) {
  PointCloud cloud = sphere_cloud(100);
  cloud.points.push_back(cloud.points[7]);
  cloud.normals.push_back(-cloud.normals[7]);
  const Samples samples = prepare_samples(cloud);
  EXPECT_EQ(samples.invalid_points, 2u);
  EXPECT_EQ(samples.points.size(), 99u);
}

TEST(Samples, GiveAStrayPointNoMoreWeightThanOthers) {
  PointCloud cloud = sphere_cloud(5000);
  cloud.points.push_back({1.3, 0, 0});
  cloud.normals.push_back(Eigen::Vector3d::UnitY());
  const Samples samples = prepare_samples(cloud);
  const double mean = std::accumulate(samples.area.begin(), samples.area.end(), 0.0) / 5001;
  for (std::size_t i = 0; i < samples.points.size(); ++i) EXPECT_LT(samples.area[i], 4 * mean);
}

TEST(SampleDepths, FollowTheSpacing) {
  Samples samples;
  samples.points.resize(4);
  samples.area = {1.0 / 4096, 1.0 / 4096, 1.0 / 4097, 1.0 / 500};
  samples.sigma = {0, 1.001 / 32, 0, 0};
  // Cells of width 1 / 64, 1 / 64 + 1.5 / 32 = 1 / 16, slightly below the first, and 1 / 22; the
  // smallest area is that of a twentieth.
  EXPECT_EQ(sample_depths(samples, 3, 12), (std::vector<int>{6, 3, 6, 4}));
  EXPECT_EQ(sample_depths(samples, 5, 5), (std::vector<int>{5, 5, 5, 5}));
}

}  // namespace
}  // namespace scan
