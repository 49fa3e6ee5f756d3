// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/rbf.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/reconstruct/ssd.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

double from_torus(const Eigen::Vector3d& x) {
  return std::abs(std::hypot(std::hypot(x[0], x[1]) - 1, x[2]) - 0.35);
}

double mean_distance(const Mesh& mesh, double (*distance)(const Eigen::Vector3d&)) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += distance((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  return sum / static_cast<double>(mesh.triangles.size());
}

void expect_torus(const SurfaceResult& result) {
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 1);
}

// The middle of a facet lies off by its chord, which goes with the square of its size: a quarter
// for four times the points; the cells' sizes are powers of two, whence the room.
TEST(Rbf, ErrorFallsWithTheSquareOfTheSpacing) {
  const SurfaceResult coarse = rbf(torus_cloud(1500)), fine = rbf(torus_cloud(6000));
  expect_torus(coarse);
  expect_torus(fine);
  const double ratio =
      mean_distance(coarse.surface, from_torus) / mean_distance(fine.surface, from_torus);
  EXPECT_GT(ratio, 3);
  EXPECT_LT(mean_distance(fine.surface, from_torus), 1e-3);
}

// Levels' nodes are 1.74 m / 2^level apart here. A tube of radius 0.35 m needs those 0.22 m apart,
// the first that are nearer than its radius, and those 0.11 m apart would tell noise alone. A plane
// of random direction crosses 1.5 cubes per face: 1.5 * 4 pi^2 * 0.35 / 0.22^2 = 430 nodes. A fit
// that follows all of them has sigma sqrt(430 / 20000) = 0.0029 of noise in the root mean square,
// and sigma^2 / (2 * 0.35) = 0.0006 more, by which scatter about a bent surface lies outside it:
// together 0.0030, in the mean sqrt(2 / pi) of that, 0.0024. With one more level it would be
// 0.0047.
TEST(Rbf, DoesNotFollowNoise) {
  for (const std::uint64_t seed : {4u, 9u}) {
    SCOPED_TRACE(seed);
    const SurfaceResult result =
        rbf(scattered(torus_cloud(20000, 1, 0.35, 100 + seed), 0.02, seed));
    expect_torus(result);
    EXPECT_LT(mean_distance(result.surface, from_torus), 0.0024);
    EXPECT_NEAR(result.sigma_m, 0.02, 0.004);
  }
}

// A cap of half-angle 0.4 is missing: the surface goes over it smoothly and says so.
TEST(Rbf, ClosesAHoleAndMarksIt) {
  const PointCloud whole = sphere_cloud(6000);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < whole.size(); ++i)
    if (whole.points[i][2] < std::cos(0.4)) kept.push_back(i);
  const SurfaceResult result = rbf(subset(whole, kept));
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.genus, 0);
  double farthest = 0;
  for (std::size_t v = 0; v < result.surface.vertices.size(); ++v) {
    farthest = std::max(farthest, result.support_m[v]);
    // A flat lid would lie 1 - cos 0.4 = 0.079 below the sphere.
    EXPECT_NEAR(result.surface.vertices[v].norm(), 1, 0.02);
  }
  EXPECT_NEAR(farthest, 0.4, 0.05);
}

// The sphere that all begins with is the surface: its facets are no larger for that. A facet of a
// spacing of 0.046 m sags by at most 0.046^2 / 8 = 2.6e-4 along its side, twice that along the
// diagonal of a cell.
TEST(Rbf, HasSmallFacetsWhereNoLevelHasAnythingToAdd) {
  const SurfaceResult result = rbf(sphere_cloud(6000));
  const double worst = mean_distance(
      result.surface, [](const Eigen::Vector3d& x) { return std::abs(x.norm() - 1); });
  EXPECT_LT(worst, 5.2e-4);
}

// One spacing and one and a half sigma, at most halved: finer ones would cost four times as many
// values of the function and show noise.
TEST(Rbf, HasFacetsAsWideAsThoseOfSsd) {
  for (const std::size_t count : {1500, 2000, 3000}) {
    PointCloud cloud = torus_cloud(count);
    RandomStream random(6, 0, 0);
    for (auto& x : cloud.points)
      for (double& along : x) along += 0.03 * random.normal();
    EXPECT_DOUBLE_EQ(rbf(cloud).finest_cell_m, ssd(cloud).finest_cell_m) << count;
  }
}

// Sampled up to 200 times as densely on one end; 2755 samples stay. Some lie 0.3 m apart where
// there are fewest: a chord of that length leaves the tube of radius 0.35 m by 0.3^2 / (8 * 0.35) =
// 0.03 m; twice that where the next one is missing too. A surface that bulges leaves it by 0.37 m.
TEST(Rbf, DoesNotBulgeWhereSamplesAreSparse) {
  const PointCloud dense = torus_cloud(15000);
  RandomStream random(11, 0, 0);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < dense.size(); ++i)
    if (random.uniform() < std::pow(200.0, -(dense.points[i][0] + 1.35) / 2.7)) kept.push_back(i);
  const SurfaceResult result = rbf(subset(dense, kept));
  expect_torus(result);
  double worst = 0;
  for (const Eigen::Vector3d& x : result.surface.vertices) worst = std::max(worst, from_torus(x));
  EXPECT_LT(worst, 0.06);
}

// No sphere is near two balls; facets of a spacing of 0.056 m sag by 4e-4, twice that on diagonals.
TEST(Rbf, MakesNoSheetAwayFromTheSamples) {
  const PointCloud ball = sphere_cloud(4000);
  PointCloud pair = ball;
  for (auto& x : pair.points) x[2] += 1.5;
  PointCloud other = ball;
  for (auto& x : other.points) x[2] -= 1.5;
  append(pair, other);
  const SurfaceResult result = rbf(pair);
  EXPECT_EQ(edge_census(result.surface).components, 2u);
  for (const Eigen::Vector3d& x : result.surface.vertices) {
    const Eigen::Vector3d centre(0, 0, x[2] > 0 ? 1.5 : -1.5);
    ASSERT_NEAR((x - centre).norm(), 1, 8e-4);
  }
}

TEST(Rbf, RefusesADepthOutsideItsLimits) {
  EXPECT_THROW(rbf(sphere_cloud(100), {.max_depth = 2}), Error);
  EXPECT_THROW(rbf(sphere_cloud(100), {.max_depth = 21}), Error);
}

}  // namespace
}  // namespace scan
