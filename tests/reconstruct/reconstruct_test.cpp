// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Every method behind the one call.
#include "libscan/reconstruct/reconstruct.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "tests/reconstruct/method_names.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

#ifdef LIBSCAN_WITH_CGAL
constexpr bool with_cgal = true;
#else
constexpr bool with_cgal = false;
#endif

bool is_built(ReconstructMethod method) {
  return with_cgal ||
         (method != ReconstructMethod::poisson && method != ReconstructMethod::delaunay &&
          method != ReconstructMethod::scale_space && method != ReconstructMethod::power_crust);
}

class EachMethod : public testing::TestWithParam<std::size_t> {
 protected:
  ReconstructMethod method() const { return static_cast<ReconstructMethod>(GetParam()); }
  SurfaceResult surface(const PointCloud& cloud) const {
    std::vector<Eigen::Vector3d> scanners;
    for (const auto& x : cloud.points) scanners.push_back(3 * x);
    return reconstruct(cloud, scanners, {.method = method(), .ssd = {.depth = 6}});
  }
  void SetUp() override {
    if (!is_built(method())) GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
  }
};

// 4,000 samples of the unit sphere: spacing 0.056. The coarsest method (Poisson with facets 0.375
// spacings off) stays within a third of a spacing; all are closed and face outwards.
TEST_P(EachMethod, MakesASphere) {
  const SurfaceResult result = surface(sphere_cloud(4000));
  double worst = 0;
  for (const auto& v : result.surface.vertices) worst = std::max(worst, std::abs(v.norm() - 1));
  EXPECT_LT(worst, 0.056 / 3);
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.boundary_edges, 0u);
  EXPECT_EQ(census.genus, 0);
  EXPECT_NEAR(volume_m3(result.surface), 4 * std::numbers::pi / 3, 4 * std::numbers::pi * 0.02);
  EXPECT_EQ(result.support_m.size(), result.surface.vertices.size());
}

TEST_P(EachMethod, ForgivesWrongNormals) {
  const PointCloud clean = sphere_cloud(4000);
  PointCloud cloud = clean;
  for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.normals[i] = -cloud.normals[i];
  const SurfaceResult result = surface(cloud);
  EXPECT_EQ(result.turned_normals, 1334u);
  EXPECT_TRUE(result.surface.vertices == surface(clean).surface.vertices);
}

TEST_P(EachMethod, GivesTheSameBytesForAnyNumberOfThreads) {
  const PointCloud cloud = torus_cloud(3000);
  const SurfaceResult many = surface(cloud);
  const ThreadLimit one(1);
  const SurfaceResult single = surface(cloud);
  EXPECT_TRUE(single.surface.vertices == many.surface.vertices);
  EXPECT_TRUE(single.surface.triangles == many.surface.triangles);
}

INSTANTIATE_TEST_SUITE_P(All, EachMethod, test::each_method(), test::method_name);

}  // namespace
}  // namespace scan
