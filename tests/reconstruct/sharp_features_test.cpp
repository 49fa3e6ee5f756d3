// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/sharp_features.h"

#include <gtest/gtest.h>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/reconstruct.h"
#include "tests/reconstruct/solids.h"

namespace scan {
namespace {

SurfaceResult surface_of(const PointCloud& cloud, bool sharp) {
  return reconstruct(cloud, {}, {.method = ReconstructMethod::rbf, .sharp = sharp});
}

void expect_closed(const SurfaceResult& result) {
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 0);
  EXPECT_EQ(result.support_m.size(), result.surface.vertices.size());
}

// A rounding of radius r takes (1 - pi / 4) r^2 per length of the twelve edges: with r about a
// spacing of 0.022 m, 12 * 0.215 * 5e-4 = 1.3e-3 of the volume. What is put back is exact.
TEST(SharpFeatures, PutACubesEdgesAndCornersBack) {
  const PointCloud cloud = cube_cloud(12000);
  const SurfaceResult round = surface_of(cloud, false), sharp = surface_of(cloud, true);
  expect_closed(sharp);
  EXPECT_EQ(sharp.sharp.corners, 8u);
  EXPECT_GT(sharp.sharp.edge_vertices, 12 / 0.0224);
  double worst = 0;
  for (std::size_t v = round.surface.vertices.size(); v < sharp.surface.vertices.size(); ++v) {
    Eigen::Vector3d x = sharp.surface.vertices[v].cwiseAbs();
    std::sort(x.begin(), x.end());
    worst = std::max(worst, std::abs(x[1] - 0.5) + std::abs(x[2] - 0.5));
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(std::abs(volume_m3(sharp.surface) - 1), 0.1 * std::abs(volume_m3(round.surface) - 1));
}

TEST(SharpFeatures, PutAConcaveEdgeBack) {
  const SurfaceResult result = surface_of(step_cloud(30000), true);
  expect_closed(result);
  // Where a corner's triangle has a vertex on one of its edges already, that edge ends there.
  EXPECT_GE(result.sharp.corners, 8u);
  EXPECT_LE(result.sharp.corners, 12u);
  // Twelve corners, each off by less than the cube of a cell, 0.022 m.
  EXPECT_NEAR(volume_m3(result.surface), 0.75, 12 * 1.1e-5);
}

TEST(SharpFeatures, LeaveASmoothSurfaceAlone) {
  const PointCloud cloud = torus_cloud(4000);
  const SurfaceResult plain = surface_of(cloud, false), sharp = surface_of(cloud, true);
  EXPECT_EQ(sharp.sharp.moved_vertices, 0u);
  EXPECT_TRUE(sharp.surface.vertices == plain.surface.vertices);
  EXPECT_TRUE(sharp.surface.triangles == plain.surface.triangles);
}

// A height of less than a thousandth of the longest side, or none: vertices that met on an edge.
TEST(SharpFeatures, LeaveNoSlivers) {
  const Mesh mesh = surface_of(cube_cloud(3000), true).surface;
  for (const Triangle& t : mesh.triangles) {
    double longest2 = 0;
    for (int k = 0; k < 3; ++k)
      longest2 =
          std::max(longest2, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).squaredNorm());
    ASSERT_GT(2 * area_vector(mesh, t).norm(), 1e-3 * longest2);
  }
  EXPECT_EQ(edge_census(mesh).non_manifold_edges, 0u);
}

TEST(SharpFeatures, AreTheSameForAnyNumberOfThreads) {
  const PointCloud cloud = cube_cloud(3000);
  const SurfaceResult many = surface_of(cloud, true);
  const ThreadLimit one(1);
  const SurfaceResult single = surface_of(cloud, true);
  EXPECT_TRUE(single.surface.vertices == many.surface.vertices);
  EXPECT_TRUE(single.surface.triangles == many.surface.triangles);
}

}  // namespace
}  // namespace scan
