// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/local_surface.h"

#include <gtest/gtest.h>

#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

LocalFit fit_of_first(const std::vector<Vector3d>& points) {
  LocalSurface surface(points);
  surface.prepare(std::vector<std::uint32_t>{0});
  return surface.fit(0);
}

TEST(LocalSurface, TellsLineSurfaceAndVolumeApart) {
  std::vector<Vector3d> line, flat, cube;
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    line.push_back(x * Vector3d(0, 0.6, 0.8));
    flat.emplace_back(x, y, 0);
    cube.emplace_back(x, y, z);
  }
  flat[0] = Vector3d(0.5, 0.5, 0);
  cube[0] = Vector3d(0.5, 0.5, 0.5);
  EXPECT_EQ(fit_of_first(line).shape, LocalShape::line);
  EXPECT_NEAR(std::abs(fit_of_first(line).direction.dot(Vector3d(0, 0.6, 0.8))), 1, 1e-12);
  EXPECT_EQ(fit_of_first(flat).shape, LocalShape::surface);
  EXPECT_NEAR(std::abs(fit_of_first(flat).direction.z()), 1, 1e-12);
  EXPECT_NEAR(std::abs(fit_of_first(flat).second_normal.z()), 1, 1e-12);
  EXPECT_EQ(fit_of_first(cube).shape, LocalShape::volume);
}

// Ten copies of each point change nothing: the fit looks at distinct points.
TEST(LocalSurface, RepeatedPointsCountOnce) {
  const PointCloud once = test::plane(500, 2);
  std::vector<Vector3d> ten;
  for (int i = 0; i < 10; ++i) ten.insert(ten.end(), once.points.begin(), once.points.end());
  EXPECT_EQ(fit_of_first(ten).shape, LocalShape::surface);
  EXPECT_EQ(LocalSurface(ten).spacing_m(), LocalSurface(once.points).spacing_m());
}

TEST(LocalSurface, SpacingOfAGridIsItsStep) {
  std::vector<Vector3d> grid;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) grid.emplace_back(0.25 * i, 0.25 * j, 0);
  EXPECT_EQ(LocalSurface(grid).spacing_m(), 0.25);
}

// Two fits to different neighbours differ by the sum of their variances. A plane fit over k points
// spread evenly in a disc of radius rho tilts with variance sigma^2 / (k rho^2 / 4) per axis; the
// inner disc holds 17 points, the outer ring 16 at nearly twice the mean square radius, so the
// difference lies between once and twice the inner variance (per axis; two axes).
TEST(LocalSurface, SecondNormalHasNoiseOfItsOwn) {
  PointCloud cloud = test::plane(20000, 3);
  test::add_noise(cloud, 0.005, 4);
  LocalSurface surface(cloud.points);
  std::vector<std::uint32_t> middle;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.points[i].head<2>().cwiseAbs().maxCoeff() < 4) middle.push_back(i);
  surface.prepare(middle);
  double difference2 = 0, tilt2 = 0;
  for (const std::uint32_t i : middle) {
    const LocalFit& fit = surface.fit(i);
    const double sign = fit.direction.dot(fit.second_normal) < 0 ? -1 : 1;
    difference2 += (fit.direction - sign * fit.second_normal).squaredNorm();
    tilt2 += 1 - fit.direction.z() * fit.direction.z();
  }
  EXPECT_GT(difference2 / tilt2, 1);
  EXPECT_LT(difference2 / tilt2, 2);
}

}  // namespace
}  // namespace scan
