// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/delaunay.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

#ifdef LIBSCAN_WITH_CGAL
TEST(Delaunay, InterpolatesASphereAndFollowsItsNormals) {
  PointCloud cloud = sphere_cloud(2000);
  const SurfaceResult outward = delaunay(cloud);
  for (const auto& v : outward.surface.vertices) EXPECT_NEAR(v.norm(), 1, 1e-15);
  EXPECT_EQ(outward.stop, SolveStop::direct);
  EXPECT_GT(volume_m3(outward.surface), 4.0);  // 4 pi / 3 less the caps under the facets
  for (auto& n : cloud.normals) n = -n;
  EXPECT_NEAR(volume_m3(delaunay(cloud).surface), -volume_m3(outward.surface), 1e-12);
}

TEST(Delaunay, RefusesTooFewPoints) {
  EXPECT_THROW(delaunay(sphere_cloud(3)), Error);
}
#else
TEST(Delaunay, InterpolatesASphereAndFollowsItsNormals) {
  GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
}

TEST(Delaunay, SaysThatItWasLeftOut) {
  try {
    delaunay(sphere_cloud(100));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::usage);
  }
}
#endif

}  // namespace
}  // namespace scan
