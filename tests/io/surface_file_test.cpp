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
  SupportedMesh surface{torus(3, 1, 7, 5), {}, {}, {}};
  for (std::size_t i = 0; i < surface.mesh.vertices.size(); ++i) {
    surface.support_m.push_back(1.0 / (3 + static_cast<double>(i)));
    surface.data_spacing_m.push_back(1.0 / (11 + static_cast<double>(i)));
    surface.standard_error_m.push_back(1e-5 / (7 + static_cast<double>(i)));
  }
  for (const char* name : {"surface.ply", "SURFACE.PLY"}) {
    write_supported_mesh(folder / name, surface);
    const SupportedMesh read = read_supported_mesh(folder / name);
    EXPECT_EQ(read.mesh.vertices, surface.mesh.vertices);
    EXPECT_EQ(read.mesh.triangles, surface.mesh.triangles);
    EXPECT_EQ(read.support_m, surface.support_m);
    EXPECT_EQ(read.data_spacing_m, surface.data_spacing_m);
    EXPECT_EQ(read.standard_error_m, surface.standard_error_m);
  }
}

TEST(SupportedMesh, WithoutListsIsAPlainMesh) {
  const TemporaryFolder folder;
  const SupportedMesh plain{cube(1), {}, {}, {}};
  for (const char* name : {"surface.ply", "surface.off"}) {
    write_supported_mesh(folder / name, plain);
    const SupportedMesh read = read_supported_mesh(folder / name);
    EXPECT_EQ(read.mesh.vertices, plain.mesh.vertices);
    EXPECT_TRUE(read.support_m.empty());
    EXPECT_TRUE(read.data_spacing_m.empty());
    EXPECT_TRUE(read.standard_error_m.empty());
  }
}

TEST(SupportedMesh, RefusesListsOfOtherLength) {
  const TemporaryFolder folder;
  const SupportedMesh wrong{cube(1), {1}, {}, {}};
  error_of([&] { write_supported_mesh(folder / "surface.ply", wrong); });
}

}  // namespace
}  // namespace scan
