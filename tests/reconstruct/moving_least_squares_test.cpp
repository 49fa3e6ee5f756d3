// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/moving_least_squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "libscan/core/error.h"
#include "tests/reconstruct/shapes.h"
#include "tests/reconstruct/solids.h"

namespace scan {
namespace {

// The field is the sphere's distance wherever it is known, and normal weights change nothing on a
// sphere that fits: each vertex is a root to 1e-7 of an edge, but for those kept 5e-4 of an edge
// (of 0.035) off its ends.
TEST(Mls, IsExactOnASphere) {
  const SurfaceResult result = mls(sphere_cloud(4000), {.support_spacings = 3});
  for (const auto& v : result.surface.vertices) EXPECT_NEAR(v.norm(), 1, 5e-4 * 0.04);
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
}

TEST(Mls, IsExactOnAPlaneAndEndsWithIt) {
  PointCloud cloud;
  RandomStream random(3, 0, 0);
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 2) / 3;
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  for (int i = 0; i < 3000; ++i) {
    const double a = random.uniform(), b = random.uniform();
    cloud.points.push_back(a * u + b * v);
    cloud.normals.push_back(normal);
  }
  const SurfaceResult result = mls(cloud, {.support_spacings = 3});
  for (const auto& x : result.surface.vertices) EXPECT_NEAR(normal.dot(x), 0, 1e-9);
  EXPECT_GT(edge_census(result.surface).boundary_edges, 0u);
  // The surface ends within one and a half supports of 3 spacings of 0.018, wider where samples are
  // few.
  EXPECT_GT(area_m2(result.surface), 0.95);
  EXPECT_LT(area_m2(result.surface), std::pow(1 + 2 * 1.5 * 3 * 0.03, 2));
}

// Points off by 1 % of the radius. The kernel (1 - t^2)^4 counts (1/5)^2 / (1/9) = 0.36 of the
// samples in its disc: with a support of 3 spacings 0.36 x 9 pi = 10.2. A sphere has no bias.
TEST(Mls, SmoothsNoiseByTheRootOfTheSamples) {
  PointCloud cloud = sphere_cloud(4000);
  RandomStream random(5, 0, 0);
  for (auto& x : cloud.points) {
    const double a = random.normal(), b = random.normal(), c = random.normal();
    x += 0.01 * Eigen::Vector3d(a, b, c);
  }
  const auto rms = [](const SurfaceResult& result) {
    double sum2 = 0;
    for (const auto& v : result.surface.vertices) sum2 += std::pow(v.norm() - 1, 2);
    return std::sqrt(sum2 / static_cast<double>(result.surface.vertices.size()));
  };
  // Its supports tile the sphere some 400 times: the rms is right to 1 / sqrt(800), 4 %; three of
  // these, and random samples leave some discs emptier.
  EXPECT_NEAR(rms(mls(cloud, {.support_spacings = 3})), 0.01 / std::sqrt(10.2), 0.15 * 0.0031);
  // Chosen, it is wider, since that is better here.
  const SurfaceResult chosen = mls(cloud);
  EXPECT_LT(rms(chosen), 0.01 / std::sqrt(30.0));
  EXPECT_EQ(edge_census(chosen.surface).components, 1u);
}

// A plate of 1 x 1 x 0.01 m, whose sides are a spacing apart and both lie within every support:
// without a fit to each side there was no surface between them, but 128 pieces. Its faces are
// whole: rims may only be where a support, less than six cells, reaches over the plate's edge.
TEST(Mls, KeepsTheFacesOfAThinPlateWhole) {
  PointCloud plate = cube_cloud(18'000);
  std::vector<std::uint32_t> kept;
  RandomStream random(4, 0, 0);
  for (std::uint32_t i = 0; i < plate.size(); ++i) {
    plate.points[i][2] *= 0.01;
    if (std::abs(plate.normals[i][2]) > 0.5 || random.uniform() < 0.01) kept.push_back(i);
  }
  const SurfaceResult result = mls(subset(plate, kept));
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_EQ(census.components, 1u);
  const double rim_m = 0.5 - 6 * result.finest_cell_m;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles;
  for (const Triangle& t : result.surface.triangles)
    for (int k = 0; k < 3; ++k) ++triangles[std::minmax({t[k], t[(k + 1) % 3]})];
  for (const auto& [edge, count] : triangles)
    if (count == 1) {
      ASSERT_GT(result.surface.vertices[edge.first].head<2>().cwiseAbs().maxCoeff(), rim_m);
    }
}

// Off an edge, at the end of the supports, the last samples may all be of one side, whose plane
// goes on there: the surface had sheets along it, which ended where nothing was known. A closed
// body's surface is closed.
TEST(Mls, MakesNoSheetsOffExactEdges) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(seed);
    const EdgeCensus census = edge_census(mls(cube_cloud(20'000, seed)).surface);
    EXPECT_TRUE(census.watertight);
    EXPECT_EQ(census.components, 1u);
    EXPECT_EQ(census.genus, 0);
  }
}

TEST(Mls, RefusesOptionsOutsideTheirLimits) {
  EXPECT_THROW(mls(sphere_cloud(100), {.support_spacings = 0.5}), Error);
  EXPECT_THROW(mls(sphere_cloud(100), {.max_depth = 30}), Error);
}

}  // namespace
}  // namespace scan
