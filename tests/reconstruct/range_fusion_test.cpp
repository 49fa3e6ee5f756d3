// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/range_fusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/reconstruct/solids.h"

namespace scan {
namespace {

struct Scanned {
  PointCloud cloud;
  std::vector<Eigen::Vector3d> viewpoints;
};

// A square of 2 m at z = 0 seen from two scanners above.
Scanned scanned_plane() {
  Scanned scanned;
  RandomStream random(3, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    const double x = 2 * random.uniform() - 1, y = 2 * random.uniform() - 1;
    scanned.cloud.points.push_back({x, y, 0});
    scanned.cloud.normals.push_back(Eigen::Vector3d::UnitZ());
    scanned.viewpoints.push_back({i % 2 == 0 ? -1.0 : 1.0, 0, 3});
  }
  return scanned;
}

// Every point says the height over the plane, so their mean does; rays end on it, and pass places
// above it only, which pushes none of the surface.
TEST(RangeFusion, IsExactOnAPlane) {
  const Scanned scanned = scanned_plane();
  const SurfaceResult result = range_fusion(scanned.cloud, scanned.viewpoints);
  // The plane runs through corners of the grid, and vertices are kept 5e-4 of an edge off them.
  for (const auto& v : result.surface.vertices)
    EXPECT_LT(std::abs(v[2]), 5.1e-4 * result.finest_cell_m);
  // The rim: a reach of 2.5 spacings, which count up to sqrt(2) as much where half a disc is empty.
  EXPECT_LT(area_m2(result.surface), 4 + 8 * 2.5 * 0.02 * std::sqrt(2.0));
  EXPECT_GT(area_m2(result.surface), 4);  // nothing that was seen is missing
  RecordProperty("area", std::to_string(area_m2(result.surface)));
  EXPECT_GT(vertex_normals(result.surface)[result.surface.vertices.size() / 2][2], 0.99);
}

// A patch of strays over the plane, with a fifth of the density of the rays that pass through it to
// the plane (10,000 over 4 x (2.5 / 3)^2 square metres there): their majority decides.
TEST(RangeFusion, SeesThroughStrays) {
  Scanned scanned = scanned_plane();
  RandomStream random(4, 0, 0);
  for (int i = 0; i < 70; ++i) {
    const double x = 0.3 * random.uniform(), y = 0.3 * random.uniform();
    scanned.cloud.points.push_back({x, y, 0.5});
    scanned.cloud.normals.push_back(Eigen::Vector3d::UnitZ());
    scanned.viewpoints.push_back({1, 0, 3});
  }
  const auto highest = [](const SurfaceResult& result) {
    double most = -1;
    for (const auto& v : result.surface.vertices) most = std::max(most, v[2]);
    return most;
  };
  EXPECT_LT(highest(range_fusion(scanned.cloud, scanned.viewpoints)), 0.1);
  // From beside them no ray passes, and they stay.
  for (std::size_t i = 0; i < 10000; ++i) scanned.viewpoints[i] = scanned.cloud.points[i];
  for (std::size_t i = 0; i < 10000; ++i) scanned.viewpoints[i][2] = 0.2;
  EXPECT_NEAR(highest(range_fusion(scanned.cloud, scanned.viewpoints)), 0.5, 0.01);
}

// The unit sphere from six scanners 3 m off along the axes, many of whose rays graze it. Distances
// from tangent planes, averaged over a reach of r, are off by r^2 / 8 there, 2 mm: a place between
// two tangent planes is not.
TEST(RangeFusion, FollowsASphere) {
  Scanned scanned{sphere_cloud(5000), {}};
  for (std::size_t i = 0; i < scanned.cloud.size(); ++i) {
    const int first = static_cast<int>(i % 6);  // the next one that sees the point
    for (int k = first; k < first + 6; ++k) {
      const Eigen::Vector3d scanner = (k % 2 == 0 ? 3.0 : -3.0) * Eigen::Vector3d::Unit(k / 2 % 3);
      if (scanned.cloud.normals[i].dot(scanner - scanned.cloud.points[i]) <= 0) continue;
      scanned.viewpoints.push_back(scanner);
      break;
    }
  }
  ASSERT_EQ(scanned.viewpoints.size(), scanned.cloud.size());
  const SurfaceResult result = range_fusion(scanned.cloud, scanned.viewpoints);
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.genus, 0);
  double mean = 0;
  for (const auto& v : result.surface.vertices) mean += v.norm() - 1;
  mean /= static_cast<double>(result.surface.vertices.size());
  const double reach_m = 2.5 * std::sqrt(4 * std::numbers::pi / 5000);
  EXPECT_LT(std::abs(mean), 0.1 * reach_m * reach_m / 8);
}

// Two sheets 1.8 spacings apart, seen from both sides: each is where its own points say, though the
// other's lie within their reach and rays pass behind it, from behind.
TEST(RangeFusion, KeepsAThinWall) {
  Scanned scanned;
  RandomStream random(5, 0, 0);
  for (int i = 0; i < 4000; ++i) {
    const double side = i % 2 == 0 ? 1 : -1, x = random.uniform(), y = random.uniform();
    scanned.cloud.points.push_back({x, y, 0.02 * side});
    scanned.cloud.normals.push_back(side * Eigen::Vector3d::UnitZ());
    scanned.viewpoints.push_back({0.5, 0.5, 3 * side});
  }
  const SurfaceResult result = range_fusion(scanned.cloud, scanned.viewpoints);
  std::size_t above = 0, below = 0;
  for (const auto& v : result.surface.vertices) {
    if ((v - Eigen::Vector3d(0.5, 0.5, v[2])).lpNorm<Eigen::Infinity>() > 0.4) continue;
    EXPECT_NEAR(std::abs(v[2]), 0.02, 5.1e-4 * result.finest_cell_m);
    ++(v[2] > 0 ? above : below);
  }
  const double cells = 0.8 / result.finest_cell_m;  // along the middle part
  EXPECT_GT(std::min(above, below), static_cast<std::size_t>(cells * cells));
}

// Beside an edge the samples round the corner lie within reach. Their normals differ by sqrt(2),
// which leaves them exp(-2 / 0.64) of their weight, and they speak of 3 spacings at most.
TEST(RangeFusion, KeepsFacesFlatBesideEdges) {
  Scanned scanned{cube_cloud(6000), {}};
  for (const auto& normal : scanned.cloud.normals) scanned.viewpoints.push_back(3 * normal);
  const SurfaceResult result = range_fusion(scanned.cloud, scanned.viewpoints);
  const double spacing_m = std::sqrt(6.0 / 6000);
  std::size_t beside = 0;
  for (const auto& v : result.surface.vertices) {
    Eigen::Vector3d x = v.cwiseAbs();
    std::sort(x.begin(), x.end());
    if (x[1] > 0.5 - 1.5 * spacing_m || x[1] < 0.5 - 3 * spacing_m) continue;
    EXPECT_NEAR(x[2], 0.5, std::exp(-2 / 0.64) * 3 * spacing_m);
    ++beside;
  }
  EXPECT_GT(beside, 100u);
}

TEST(RangeFusion, GivesTheSameForAnyNumberOfThreads) {
  const Scanned scanned = scanned_plane();
  const Mesh many = range_fusion(scanned.cloud, scanned.viewpoints).surface;
  const ThreadLimit one(1);
  const Mesh single = range_fusion(scanned.cloud, scanned.viewpoints).surface;
  EXPECT_TRUE(single.vertices == many.vertices && single.triangles == many.triangles);
}

TEST(RangeFusion, NeedsItsScanners) {
  EXPECT_THROW(range_fusion(scanned_plane().cloud, {}), Error);
}

}  // namespace
}  // namespace scan
