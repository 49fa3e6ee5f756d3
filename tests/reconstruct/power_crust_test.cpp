// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/power_crust.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

#ifdef LIBSCAN_WITH_CGAL

SurfaceResult crust_of(const PointCloud& cloud, double spacing_m) {
  return power_crust(cloud, std::vector<double>(cloud.size(), spacing_m));
}

void expect_closed(const Mesh& mesh, long genus) {
  const EdgeCensus census = edge_census(mesh);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, genus);
}

// A ring of tube radius 0.35, sampled every 0.05 along and around: no place of it is farther than
// d = 0.0354 from a sample (outside it is 1.35 times as far along). Facets between samples are off
// by their sagitta, d^2 / 2 r for the tube, and a ball that does for others by
// spacing^2 / 8 r.
TEST(PowerCrust, IsNearARing) {
  constexpr double r = 0.35, spacing = 0.05;
  const int around = static_cast<int>(2 * std::numbers::pi * r / spacing);
  const int along = static_cast<int>(2 * std::numbers::pi / spacing);
  PointCloud ring;
  RandomStream random(4, 0, 0);
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < around; ++k) {
      const double u = 2 * std::numbers::pi * (i + 0.1 * random.uniform()) / along;
      const double v = 2 * std::numbers::pi * (k + 0.1 * random.uniform()) / around;
      const double out = 1 + r * std::cos(v);
      ring.points.emplace_back(out * std::cos(u), out * std::sin(u), r * std::sin(v));
    }
  const SurfaceResult result = crust_of(ring, spacing);
  expect_closed(result.surface, 1);
  const double farthest = 0.5 * std::hypot(1.1 * spacing * 1.35, 1.1 * spacing);
  const double limit = farthest * farthest / (2 * r) + spacing * spacing / (8 * r);
  for (const auto& x : result.surface.vertices)
    EXPECT_NEAR(std::hypot(std::hypot(x[0], x[1]) - 1, x[2]), r, limit);
  EXPECT_GT(volume_m3(result.surface), 0);  // faces outwards
}

// Outside it are balls along a straight axis, whose planes of equal power nearly coincide. Uniform
// samples n to the area A leave a disc of radius d empty near one of them with a chance of
// exp(-n pi d^2 / A): with n pi d^2 / A = ln n + 5 near hardly any. Limit as for IsNearARing.
TEST(PowerCrust, HasNoSpikesAlongAStraightAxis) {
  constexpr double r = 0.35, n = 30000, area = 4 * std::numbers::pi * std::numbers::pi * r;
  const double spacing = std::sqrt(area / n);
  const SurfaceResult result = crust_of(torus_cloud(30000), spacing);
  const double empty2 = area * (std::log(n) + 5) / (n * std::numbers::pi);
  const double limit = empty2 / (2 * r) + spacing * spacing / (8 * r);
  for (const auto& x : result.surface.vertices)
    EXPECT_NEAR(std::hypot(std::hypot(x[0], x[1]) - 1, x[2]), r, limit);
}

// 11 x 11 points on each face of a cube: hundreds lie in one plane and on one sphere. Between the
// points, 0.71 from the nearest, a ball of radius r comes short of its face by 0.71^2 / 2 r. Inside
// they are of radius 1 beside an edge and of 3 where that is three away; outside they are larger.
TEST(PowerCrust, OfALatticeOnACubeIsTheCube) {
  PointCloud cube;
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= 10; ++j)
      for (int k = 0; k <= 10; ++k)
        if (i % 10 == 0 || j % 10 == 0 || k % 10 == 0) cube.points.emplace_back(i, j, k);
  const SurfaceResult result = crust_of(cube, 1);
  expect_closed(result.surface, 0);
  for (const auto& x : result.surface.vertices) {
    Eigen::Vector3d off = (x - Eigen::Vector3d::Constant(5)).cwiseAbs();
    std::sort(off.begin(), off.end());
    EXPECT_NEAR(off[2], 5, off[1] < 2 ? 0.5 / 6 : 0.5 / 2);
  }
}

// Planes of equal power that coincide but for rounding meet anywhere along them.
TEST(PowerCrust, HasNoSpikesWhereManyPointsLieInOnePlane) {
  RandomStream random(9, 0, 0);
  PointCloud box;
  while (box.size() < 6000) {
    Eigen::Vector3d x;
    for (int k = 0; k < 3; ++k) x[k] = random.uniform() - 0.5;
    const int side = static_cast<int>(6 * random.uniform());
    x[side / 2] = side % 2 - 0.5;
    box.points.push_back(x);
  }
  const SurfaceResult result = crust_of(box, 1 / std::sqrt(1000.0));
  expect_closed(result.surface, 0);
  for (const auto& x : result.surface.vertices) EXPECT_LT(x.cwiseAbs().maxCoeff(), 0.52);
}

// A hull of n points has n vertices; around each several cells end in corners on one another, which
// are merged but for some that would fold.
TEST(PowerCrust, HasHardlyMoreVerticesThanASphereHasPoints) {
  const SurfaceResult result = crust_of(sphere_cloud(4000), 0.056);
  EXPECT_GE(result.surface.vertices.size(), 3900u);
  EXPECT_LE(result.surface.vertices.size(), 4400u);
}

// At 10^6 m doubles are 1e-10 apart; a corner may lie a hundred times as far off as its balls.
TEST(PowerCrust, IsTheSameFarAway) {
  const PointCloud ring = torus_cloud(1500);
  PointCloud far = ring;
  const Eigen::Vector3d offset(1e6, -2e6, 3e6);
  for (auto& x : far.points) x += offset;
  const SurfaceResult result = crust_of(far, 0.1);
  expect_closed(result.surface, 1);
  for (const auto& x : result.surface.vertices) {
    const Eigen::Vector3d y = x - offset;
    EXPECT_NEAR(std::hypot(std::hypot(y[0], y[1]) - 1, y[2]), 0.35, 0.1);
  }
}

// Three quarters of a sphere: the balls inside reach the rim and close it.
TEST(PowerCrust, ClosesAHoleAndMarksIt) {
  PointCloud cap;
  for (const auto& x : sphere_cloud(4000).points)
    if (x[2] < 0.5) cap.points.push_back(x);
  const SurfaceResult result = crust_of(cap, 0.056);
  expect_closed(result.surface, 0);
  // Between the ball cut off below the rim, by as much as the samples leave open, and the whole
  // one.
  const double whole = 4 * std::numbers::pi / 3;
  EXPECT_LT(volume_m3(result.surface), whole * 1.001);
  const double height = 0.5 + 0.056;
  EXPECT_GT(volume_m3(result.surface), whole * (1 - height * height * (3 - height) / 4));
  EXPECT_GT(*std::max_element(result.support_m.begin(), result.support_m.end()), 3 * 0.056);
}

TEST(PowerCrust, StaysWholeWhereAdvancingFrontsBreak) {
  const SurfaceResult result = crust_of(scattered(torus_cloud(8000), 0.02), 0.04);
  EXPECT_NEAR(result.sigma_m, 0.02, 0.004);
  expect_closed(result.surface, 1);
  const double ring = 2 * std::numbers::pi * std::numbers::pi * 0.35 * 0.35;
  EXPECT_NEAR(volume_m3(result.surface), ring,
              0.02 * 4 * std::numbers::pi * std::numbers::pi * 0.35);
}

// The layer is some ten spacings thick: no point is touched by a ball inside and by one outside.
TEST(PowerCrust, CrossesAThickLayerOfPoints) {
  const SurfaceResult result = crust_of(scattered(torus_cloud(40000), 0.03), 0.018);
  expect_closed(result.surface, 1);
}

// By a power of two nothing is rounded, so the micrometre comes out as the metre does.
TEST(PowerCrust, HasNoUnit) {
  const PointCloud ring = torus_cloud(1500);
  PointCloud tiny = ring;
  const double scale = std::ldexp(1.0, -20);
  for (auto& x : tiny.points) x *= scale;
  const Mesh large = crust_of(ring, 0.1).surface, small = crust_of(tiny, 0.1 * scale).surface;
  ASSERT_EQ(small.triangles, large.triangles);
  for (std::size_t v = 0; v < small.vertices.size(); ++v)
    EXPECT_LT((small.vertices[v] / scale - large.vertices[v]).norm(), 1e-9);
}

TEST(PowerCrust, IsTheSameForAnyNumberOfThreads) {
  const PointCloud ring = scattered(torus_cloud(1500), 0.01);
  const auto on_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return crust_of(ring, 0.1).surface;
  };
  const Mesh one = on_threads(1), three = on_threads(3);
  EXPECT_EQ(one.triangles, three.triangles);
  EXPECT_EQ(one.vertices, three.vertices);
}

TEST(PowerCrust, SaysThatASheetHasNoInside) {
  PointCloud sheet;
  RandomStream random(7, 0, 0);
  for (int i = 0; i < 400; ++i) {
    const double x = random.uniform(), y = random.uniform();
    sheet.points.emplace_back(x, y, 0.1 * x * y);
  }
  try {
    crust_of(sheet, 0.05);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::computation);
    EXPECT_NE(std::string(error.what()).find("enclose nothing"), std::string::npos);
  }
}

#else

TEST(PowerCrust, SaysThatItIsNotBuilt) {
  EXPECT_THROW(power_crust({}, {}), Error);
}

#endif

}  // namespace
}  // namespace scan
