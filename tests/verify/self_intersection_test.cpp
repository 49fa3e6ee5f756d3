// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Meshes with a known number of crossing triangles.
#include "libscan/verify/self_intersection.h"

#include <gtest/gtest.h>

#include "tests/core/meshes.h"

namespace scan {
namespace {

double crossings(const Mesh& mesh) {
  const auto measured = self_intersection(mesh);
  return measured ? measured->value : -1;
}

class SelfIntersection : public testing::Test {
#ifndef LIBSCAN_WITH_CGAL
  void SetUp() override {
    GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
  }
#endif
};

TEST_F(SelfIntersection, OfEmbeddedSolidsIsNone) {
  EXPECT_EQ(crossings(cube(1)), 0);
  EXPECT_EQ(crossings(torus(3, 1, 20, 12)), 0);
}

TEST_F(SelfIntersection, OfTwoCrossingTrianglesIsOne) {
  const Mesh cross{{{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}, {0, 0, -1}, {0.2, 0, 1}, {0, 0.3, 1}},
                   {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(crossings(cross), 1);
}

TEST_F(SelfIntersection, OfANonManifoldMeshIsNotKnown) {
  const Mesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                 {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  EXPECT_FALSE(self_intersection(fan).has_value());
}

// A tube thicker than its ring overlaps itself around the axis.
TEST_F(SelfIntersection, OfASpindleTorusIsSeen) {
  EXPECT_GT(crossings(torus(1, 1.5, 20, 13)), 0);
}

}  // namespace
}  // namespace scan
