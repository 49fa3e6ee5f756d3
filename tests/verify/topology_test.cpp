// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Topology of known meshes as measurements.
#include <gtest/gtest.h>

#include <cmath>

#include "libscan/verify/surface_error.h"
#include "tests/core/meshes.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

TEST(Topology, OfATorus) {
  const auto figures = topology(torus(3, 1, 12, 8));
  EXPECT_EQ(figure(figures, "components"), 1);
  EXPECT_EQ(figure(figures, "boundary_edges"), 0);
  EXPECT_EQ(figure(figures, "non_manifold_edges"), 0);
  EXPECT_EQ(figure(figures, "genus"), 1);
}

TEST(Topology, OfAnOpenMeshHasNoGenus) {
  Mesh mesh = cube(1);
  mesh.triangles.pop_back();
  const auto figures = topology(mesh);
  EXPECT_EQ(figure(figures, "boundary_edges"), 3);
  EXPECT_TRUE(std::isnan(figure(figures, "genus")));
}

}  // namespace
}  // namespace scan
