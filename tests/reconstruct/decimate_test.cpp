// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/decimate.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
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

// Heights at random between 0 and twice the width of a square, each cut along the same diagonal.
SurfaceResult rough_field(std::uint32_t side) {
  SurfaceResult result;
  RandomStream random(1, 0, 0);
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x)
      result.surface.vertices.emplace_back(x, y, 2 * random.uniform());
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = x + y * (side + 1), c = a + side + 1;
      result.surface.triangles.push_back({a, a + 1, c + 1});
      result.surface.triangles.push_back({a, c + 1, c});
    }
  return result;
}

// So rough that what is looked at on the way does not tell how far the rest is off: the first two
// results are refused.
TEST(Decimate, RefusesWhatIsNotProven) {
  SurfaceResult result = rough_field(30);
  const Mesh before = result.surface;
  const DecimateReport report = decimate(result, 0.5);
  EXPECT_TRUE(report.is_proven);
  EXPECT_LE(report.bound_m, 0.5);
  EXPECT_LT(result.surface.triangles.size(), before.triangles.size());
  EXPECT_LE(hausdorff_distance(result.surface, before, {.limit_m = 0.5}).high_m, 0.5);
}

TEST(Decimate, RefusesNoTolerance) {
  SurfaceResult result = torus();
  EXPECT_THROW(decimate(result, 0), Error);
  EXPECT_THROW(decimate(result, std::nan("")), Error);
}

}  // namespace
}  // namespace scan
