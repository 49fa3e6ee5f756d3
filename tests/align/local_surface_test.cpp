// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/local_surface.h"

#include <gtest/gtest.h>

#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

std::vector<LocalFit> fits_of(const std::vector<Vector3d>& points) {
  return local_fits(points, KdTree(points), 16);
}

TEST(LocalFits, TellLineSurfaceAndVolumeApart) {
  std::vector<Vector3d> line, flat, cube;
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    line.push_back(x * Vector3d(0, 0.6, 0.8));
    flat.emplace_back(x, y, 0);
    cube.emplace_back(x, y, z);
  }
  line[0] = Vector3d(0, 0.3, 0.4);
  flat[0] = Vector3d(0.5, 0.5, 0);
  cube[0] = Vector3d(0.5, 0.5, 0.5);
  EXPECT_EQ(fits_of(line)[0].shape, LocalShape::line);
  EXPECT_NEAR(std::abs(fits_of(line)[0].direction.dot(Vector3d(0, 0.6, 0.8))), 1, 1e-12);
  EXPECT_EQ(fits_of(flat)[0].shape, LocalShape::surface);
  EXPECT_NEAR(std::abs(fits_of(flat)[0].direction.z()), 1, 1e-12);
  EXPECT_EQ(fits_of(cube)[0].shape, LocalShape::volume);
  EXPECT_TRUE(fits_of(cube)[0].direction.isZero(0));
}

// Scan lines far apart: the nearest 16 points lie on one of them, the nearest 64 on three.
TEST(LocalFits, SeeTheSurfaceBetweenScanLines) {
  std::vector<Vector3d> lines;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 200; ++j) lines.emplace_back(0.12 * i, 0.01 * j, 0);
  const LocalFit fit = fits_of(lines)[10 * 200 + 100];
  EXPECT_EQ(fit.shape, LocalShape::surface);
  EXPECT_NEAR(std::abs(fit.direction.z()), 1, 1e-12);
}

// With ten copies of each point 16 neighbours are two places, 64 are seven.
TEST(LocalFits, LookBeyondRepeatedPoints) {
  const PointCloud once = test::plane(200, 2);
  std::vector<Vector3d> ten;
  for (int i = 0; i < 10; ++i) ten.insert(ten.end(), once.points.begin(), once.points.end());
  for (const LocalFit& fit : fits_of(ten)) {
    EXPECT_EQ(fit.shape, LocalShape::surface);
    EXPECT_TRUE(fit.tilt.allFinite());
  }
  EXPECT_EQ(spacing_m(ten, KdTree(ten)), spacing_m(once.points, KdTree(once.points)));
}

TEST(LocalFits, OfFewOrEqualPointsHaveNoDirection) {
  for (const std::size_t count : {1u, 5u, 50u}) {
    const std::vector<Vector3d> equal(count, Vector3d(1, 2, 3));
    for (const LocalFit& fit : fits_of(equal)) EXPECT_TRUE(fit.direction.isZero(0));
    EXPECT_EQ(spacing_m(equal, KdTree(equal)), 0);
  }
}

TEST(Spacing, OfAGridIsItsStep) {
  std::vector<Vector3d> grid;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) grid.emplace_back(0.25 * i, 0.25 * j, 0);
  EXPECT_EQ(spacing_m(grid, KdTree(grid)), 0.25);
}

// The tilt is a draw of the normal's own error: over the 12,800 points of the middle their mean
// squares agree. Fits of neighbours share points, so the draws count as one for every 16, 800 of
// them with two components each: the ratio of the two means has sigma sqrt(2 * 2 / 1600) = 0.05,
// of which four are allowed. To second order a half's fit tilts by sigma^2 / variance more: with
// sigma 5 mm and 16 points on 0.08 m^2, 2.5e-5 / 6e-3 = 0.4 %.
TEST(LocalFits, TiltIsADrawOfTheNormalsError) {
  PointCloud cloud = test::plane(20000, 3);
  test::add_noise(cloud, 0.005, 4);
  const std::vector<LocalFit> fits = fits_of(cloud.points);
  double tilt2 = 0, error2 = 0, product = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].head<2>().cwiseAbs().maxCoeff() > 4) continue;
    const Eigen::Vector3f& tilt = fits[i].tilt;
    const Vector3d error = fits[i].direction / fits[i].direction.z() - Vector3d::UnitZ();
    tilt2 += double(tilt.head<2>().squaredNorm());
    error2 += error.head<2>().squaredNorm();
    product += tilt.cast<double>().dot(error);
  }
  EXPECT_NEAR(tilt2 / error2, 1, 0.2);
  // And independent of it: a correlation of 1 / sqrt(1600), four of which are allowed.
  EXPECT_NEAR(product / std::sqrt(tilt2 * error2), 0, 0.1);
}

// A point 0.1 above a sheet of unit steps, 0.3 beside one of its points. It tilts the fit by
// 0.1 * 0.3 over a sum of squares of at least 10, which brings it nearer by 1 % at most.
TEST(LocalFits, KnowHowFarTheNearestPointLiesOff) {
  std::vector<Vector3d> points = {{0.3, 0, 0.1}};
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) points.emplace_back(i, j, 0);
  const LocalFit fit = fits_of(points)[1 + 3 * 7 + 3];
  EXPECT_EQ(fit.shape, LocalShape::surface);
  EXPECT_NEAR(fit.neighbour_off_m, 0.1, 0.001);
}

}  // namespace
}  // namespace scan
