// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a surface's vertices know comes back to the bit.
#include "libscan/io/surface_file.h"

#include <gtest/gtest.h>

#include "libscan/io/mesh_text.h"
#include "libscan/io/ply.h"
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

// Two quads and a triangle: whole in the file, the same halves when it is read.
TEST(SupportedMesh, KeepsQuadsWhole) {
  const TemporaryFolder folder;
  Mesh mesh;
  for (int i = 0; i < 7; ++i) mesh.vertices.push_back({i * 1.0, i * i * 0.1, 0.25 * (i % 2)});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}, {4, 6, 5}};
  mesh.quads = 2;
  write_supported_mesh(folder / "surface.ply", {mesh, {}, {}, {}});
  const Ply ply = read_ply(folder / "surface.ply");
  EXPECT_EQ(ply.find("face")->find("vertex_indices")->lengths,
            (std::vector<std::uint32_t>{4, 4, 3}));
  for (const char* name : {"surface.ply", "surface.obj", "surface.off"}) {
    write_supported_mesh(folder / name, {mesh, {}, {}, {}});
    EXPECT_EQ(read_mesh(folder / name).triangles, mesh.triangles);
  }
  EXPECT_NE(obj_text(mesh).find("f 1 2 3 4\n"), std::string::npos);
  EXPECT_NE(off_text(mesh).find("\n7 3 0\n"), std::string::npos);
}

TEST(SupportedMesh, RefusesListsOfOtherLength) {
  const TemporaryFolder folder;
  const SupportedMesh wrong{cube(1), {1}, {}, {}};
  error_of([&] { write_supported_mesh(folder / "surface.ply", wrong); });
}

}  // namespace
}  // namespace scan
