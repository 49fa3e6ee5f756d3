// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Broken copies of clouds and meshes.
#include <gtest/gtest.h>

#include "libscan/io/image_file.h"
#include "libscan/io/mesh_import.h"
#include "libscan/io/pcd.h"
#include "libscan/io/ply.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/surface_file.h"
#include "tests/fuzz/fuzz.h"
#include "tests/io/gltf_tetrahedron.h"

namespace scan::test {
namespace {

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Scan small_scan() {
  Scan scan;
  for (int i = 0; i < 8; ++i) {
    scan.cloud.points.emplace_back(0.1 * i, 1.0 / 3, 1 + 0.01 * i);
    scan.cloud.normals.emplace_back(0, 0, -1);
    scan.cloud.sigma_m.push_back(1e-4);
    scan.cloud.covariances.push_back(1e-8 * Eigen::Matrix3d::Identity());
    scan.cloud.intensity.push_back(i);
    scan.ray.push_back(static_cast<std::uint32_t>(i));
  }
  scan.grid = {2, 5};
  scan.misses["no signal"] = 2;
  return scan;
}

void read_sound_scan(const std::filesystem::path& path) {
  const Scan scan = read_scan(path);
  expect_sound(scan.cloud);
  if (!scan.ray.empty() && scan.ray.size() != scan.cloud.size())
    throw std::logic_error("rays are of another number");
}

void read_sound_mesh(const std::filesystem::path& path) {
  expect_sound(read_mesh(path));
}

TEST(Fuzz, Ply) {
  const TemporaryFolder folder;
  write_scan(folder / "scan.ply", small_scan());
  fuzz(folder / "scan.ply", read_sound_scan);
  write_mesh(folder / "mesh.ply", tetrahedron());
  fuzz(folder / "mesh.ply", read_sound_mesh);
  fuzz(folder / "mesh.ply", [](const auto& path) { (void)holds_triangles(path); });
  write_file(
      folder / "grid.ply",
      "ply\nformat ascii 1.0\nobj_info num_cols 2\nobj_info num_rows 2\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nelement range_grid 4\n"
      "property list uchar int vertex_indices\nend_header\n0 0 1\n1 0 1\n0 1 1\n1 0\n1 1\n0\n"
      "1 2\n");
  fuzz(folder / "grid.ply", read_sound_scan);
  write_supported_mesh(folder / "surface.ply",
                       {tetrahedron(), {1, 2, 3, 4}, {1, 1, 1, 1}, {0.1, 0.1, 0.1, 0.1}});
  fuzz(folder / "surface.ply",
       [](const auto& path) { expect_sound(read_supported_mesh(path).mesh); });
}

TEST(Fuzz, Pcd) {
  const TemporaryFolder folder;
  write_scan(folder / "a.pcd", small_scan());
  fuzz(folder / "a.pcd", read_sound_scan);
  write_file(
      folder / "b.pcd",
      "VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 2\nTYPE F F F U\nCOUNT 1 1 1 1\n"
      "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 2 3 4\n5 6 7 8\n");
  fuzz(folder / "b.pcd", read_sound_scan);
}

TEST(Fuzz, PointsAsTextAndNumbers) {
  const TemporaryFolder folder;
  write_scan(folder / "a.xyz", small_scan());
  fuzz(folder / "a.xyz", read_sound_scan);
  write_npy(folder / "a.npy", {2, 3}, std::vector<double>{1, 2, 3, 4, 5, 6});
  fuzz(folder / "a.npy", read_sound_scan);
}

TEST(Fuzz, StlObjOff) {
  const TemporaryFolder folder;
  for (const char* name : {"a.stl", "a.obj", "a.off"}) {
    write_mesh(folder / name, tetrahedron());
    fuzz(folder / name, read_sound_mesh);
  }
  write_file(folder / "b.stl",
             "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
             "endloop\nendfacet\nendsolid a\n");
  fuzz(folder / "b.stl", read_sound_mesh);
  write_file(
      folder / "b.obj",
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 -1/-1/-1\n");
  fuzz(folder / "b.obj", [](const auto& path) {
    const TexturedMesh textured = read_textured_mesh(path);
    expect_sound(textured.mesh);
    for (const auto& corners : textured.corners)
      for (const Eigen::Vector2d& corner : corners) expect_finite("a corner", corner);
  });
}

TEST(Fuzz, Gltf) {
  const TemporaryFolder folder;
  const Reader read = [](const auto& path) { expect_sound(read_gltf(path).mesh); };
  write_file(folder / "a.bin", gltf_buffer());
  write_file(folder / "a.gltf", gltf_document(R"("uri":"a.bin",)"));
  fuzz(folder / "a.gltf", read);
  write_file(folder / "a.glb", glb());
  fuzz(folder / "a.glb", read);
}

}  // namespace
}  // namespace scan::test
