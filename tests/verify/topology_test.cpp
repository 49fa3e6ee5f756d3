// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Topology of known meshes as measurements.
#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
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

// A cube of 12 equal triangles; at a corner meet 4 or 5 of them.
TEST(UnsupportedArea, IsThatOfTrianglesAwayFromData) {
  const Mesh mesh = cube(1);
  std::vector<double> spacings(mesh.vertices.size(), 1);
  EXPECT_EQ(unsupported_area(mesh, spacings, 1).value, 0);
  EXPECT_EQ(unsupported_area(mesh, spacings, 0).value, 1);
  spacings[0] = 1.1;
  double at_corner = 0;
  for (const Triangle& t : mesh.triangles) at_corner += t[0] == 0 || t[1] == 0 || t[2] == 0;
  EXPECT_NEAR(unsupported_area(mesh, spacings, 1).value, at_corner / 12, 1e-15);
  EXPECT_GT(at_corner, 0);
  spacings.pop_back();
  EXPECT_THROW(unsupported_area(mesh, spacings, 1), Error);
}

}  // namespace
}  // namespace scan
