// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/core/parallel.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// The median of 2000 residuals of 18 or more degrees of freedom each is known to 1.25 / sqrt(2 *
// 18 * 2000) = 0.5 %, and lies below the root mean square by 2 % (chi square of 18 degrees of
// freedom). A ball of five sigma cuts the scatter of the points in its outer tenth: some 5 % less.
// Together below 10 %. Where the scatter is wider than the spacing (0.026 here), neighbourhoods
// must grow; they see their tangent plane's curvature across 5 sigma, which a quadric follows.
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

// Bumps as wide as four spacings of the points, which no quadric over 24 points follows: it leaves
// about their root mean square, height / sqrt(8). Of pairs, whose differences vanish with their
// distance, little may be left.
TEST(Noise, IsNotTheRoughnessOfTheSurface) {
  const double spacing = std::sqrt(4 * std::numbers::pi / 20000), height = 0.01;
  const PointCloud rough = bumpy_cloud(20000, height, std::numbers::pi / (4 * spacing));
  EXPECT_LT(estimate_sigma(rough.points), 0.1 * height);
  // Scatter beside such bumps is found for itself. Of 2,000 fits' pairs some 4,000 are near: the
  // median of their squares is known to 4 %, sigma to 3 % after going on to no distance; the curve
  // of the bumps within a pair's distance adds a tenth of their residual, in squares.
  const double sigma = 1e-3;
  EXPECT_NEAR(estimate_sigma(scattered(rough, sigma).points) / sigma, 1, 0.15);
}

// Every point three times, a thousandth of the spacing apart: whether such points share one error
// is unknown, and the residual stays the estimate. Eight clumps of three leave a quadric two
// degrees of freedom, whose chi square has the median 1.39: sqrt(3 * 1.39 / 18) sigma; the ball of
// five sigma, or of eight clumps only, takes another tenth.
TEST(Noise, IsNotTakenFromClumpsOfPoints) {
  const double sigma = 0.01;
  PointCloud cloud = scattered(sphere_cloud(7000), sigma);
  const std::size_t count = cloud.size();
  for (int copy = 0; copy < 2; ++copy)
    for (std::size_t i = 0; i < count; ++i)
      cloud.points.push_back(cloud.points[i] + Eigen::Vector3d::Constant(4e-5 * (copy + 1)));
  EXPECT_NEAR(estimate_sigma(cloud.points) / (std::sqrt(3 * 1.39 / 18) * sigma), 1, 0.15);
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
