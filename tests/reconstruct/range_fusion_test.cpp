// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/range_fusion.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/reconstruct/shapes.h"

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
  EXPECT_NEAR(area_m2(result.surface), 4, 8 * 2.5 * 0.02);  // the rim: a reach of 2.5 spacings
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
