// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/decimate.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/reconstruct/ssd.h"
#include "libscan/reconstruct/trim.h"
#include "libscan/search/hausdorff.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

const SurfaceResult& torus() {
  static const SurfaceResult result = ssd(torus_cloud(3000), {.depth = 6});
  return result;
}

// A chord of length l leaves a circle of radius r by l^2 / (8 r): with r = 0.35 m and 0.01 m, l is
// 0.17 m, and 13.8 m2 of such triangles are some 1,100.
TEST(Decimate, StaysWithinItsToleranceWithFewTriangles) {
  SurfaceResult result = torus();
  const DecimateReport report = decimate(result, 0.01);
  EXPECT_TRUE(report.is_proven);
  EXPECT_EQ(report.triangles_before, torus().surface.triangles.size());
  EXPECT_LT(result.surface.triangles.size(), 3000u);
  EXPECT_LE(report.bound_m, 0.01);
  EXPECT_LE(hausdorff_distance(result.surface, torus().surface).low_m, 0.01);
  EXPECT_LE(hausdorff_distance(result.surface, torus().surface, {.limit_m = 0.01}).high_m, 0.01);
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.non_manifold_vertices, 0u);
  EXPECT_EQ(census.genus, 1);
  EXPECT_EQ(result.support_m.size(), result.surface.vertices.size());
  EXPECT_EQ(result.standard_error_m.size(), result.surface.vertices.size());
}

TEST(Decimate, KeepsMoreForLess) {
  SurfaceResult coarse = torus(), fine = torus();
  decimate(coarse, 0.02);
  decimate(fine, 0.005);
  EXPECT_LT(coarse.surface.triangles.size(), fine.surface.triangles.size());
}

TEST(Decimate, KeepsAnOpenRim) {
  SurfaceResult result = torus();
  for (std::size_t v = 0; v < result.support_m.size(); ++v)
    result.support_m[v] = result.surface.vertices[v][0] > 0 ? 1 : 0;
  trim(result, 0.5);
  const Mesh before = result.surface;
  EXPECT_TRUE(decimate(result, 0.01).is_proven);
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_GT(census.boundary_edges, 0u);
  EXPECT_EQ(census.non_manifold_edges, 0u);
  EXPECT_LE(hausdorff_distance(result.surface, before, {.limit_m = 0.01}).high_m, 0.01);
}

TEST(Decimate, RefusesNoTolerance) {
  SurfaceResult result = torus();
  EXPECT_THROW(decimate(result, 0), Error);
  EXPECT_THROW(decimate(result, std::nan("")), Error);
}

}  // namespace
}  // namespace scan
