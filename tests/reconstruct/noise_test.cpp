// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/noise.h"

#include <gtest/gtest.h>

#include "libscan/core/parallel.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// The median of 500 residuals of 18 or more degrees of freedom each is known to 1.25 / sqrt(2 * 18
// * 500) = 1 %, and lies below the root mean square by 2 % (chi square of 18 degrees of freedom). A
// ball of five sigma cuts the scatter of the points in its outer tenth: some 5 % less. Together
// below 10 %. Where the scatter is wider than the spacing (0.026 here), neighbourhoods must grow;
// they see their tangent plane's curvature across 5 sigma, which a quadric follows.
TEST(Noise, IsFoundBelowAndAboveTheSpacing) {
  for (const double sigma : {1e-3, 1e-2, 5e-2}) {
    SCOPED_TRACE(sigma);
    const PointCloud cloud = scattered(sphere_cloud(20000), sigma);
    EXPECT_NEAR(estimate_sigma(cloud.points) / sigma, 1, 0.1);
  }
}

// A quadric touches the unit sphere to fourth order: 24 neighbours lie within r = 0.07, and what is
// left of r^4 / 8 after the fit is below 1e-6.
TEST(Noise, IsNoneForExactPoints) {
  EXPECT_LT(estimate_sigma(sphere_cloud(20000).points), 1e-6);
}

TEST(Noise, IsNotDecidedByOutliers) {
  PointCloud cloud = scattered(sphere_cloud(20000), 1e-3);
  RandomStream random(4, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    cloud.points.push_back(3 * (Eigen::Vector3d(x, y, z) - Eigen::Vector3d::Constant(0.5)));
  }
  // Some neighbourhoods hold an outlier; most do not, and the median is theirs.
  EXPECT_NEAR(estimate_sigma(cloud.points) / 1e-3, 1, 0.2);
}

TEST(Noise, IsTheSameForAnyThreadCount) {
  const PointCloud cloud = scattered(torus_cloud(5000), 3e-3);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return estimate_sigma(cloud.points);
  };
  EXPECT_EQ(with_threads(1), with_threads(7));
}

}  // namespace
}  // namespace scan
