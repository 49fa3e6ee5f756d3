// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a surface's vertices know comes back to the bit.
#include "libscan/io/surface_file.h"

#include <gtest/gtest.h>

#include "libscan/io/scan_file.h"
#include "tests/core/meshes.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

TEST(SupportedMesh, ComesBackToTheBit) {
  const TemporaryFolder folder;
  const Mesh mesh = torus(3, 1, 7, 5);
  std::vector<double> support_m, standard_error_m;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    support_m.push_back(1.0 / (3 + static_cast<double>(i)));
    standard_error_m.push_back(1e-5 / (7 + static_cast<double>(i)));
  }
  for (const char* name : {"surface.ply", "SURFACE.PLY"}) {
    write_supported_mesh(folder / name, mesh, support_m, standard_error_m);
    const SupportedMesh read = read_supported_mesh(folder / name);
    EXPECT_EQ(read.mesh.vertices, mesh.vertices);
    EXPECT_EQ(read.mesh.triangles, mesh.triangles);
    EXPECT_EQ(read.support_m, support_m);
    EXPECT_EQ(read.standard_error_m, standard_error_m);
  }
}

TEST(SupportedMesh, WithoutListsIsAPlainMesh) {
  const TemporaryFolder folder;
  const Mesh mesh = cube(1);
  for (const char* name : {"surface.ply", "surface.off"}) {
    write_supported_mesh(folder / name, mesh, {}, {});
    const SupportedMesh read = read_supported_mesh(folder / name);
    EXPECT_EQ(read.mesh.vertices, mesh.vertices);
    EXPECT_TRUE(read.support_m.empty());
    EXPECT_TRUE(read.standard_error_m.empty());
  }
}

TEST(SupportedMesh, RefusesListsOfOtherLength) {
  const TemporaryFolder folder;
  const std::vector<double> one{1};
  error_of([&] { write_supported_mesh(folder / "surface.ply", cube(1), one, {}); });
}

}  // namespace
}  // namespace scan
