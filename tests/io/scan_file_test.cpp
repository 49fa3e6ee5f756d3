// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/scan_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libscan/io/ply.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

Eigen::Vector3d random_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal();
  return {x, y, random.normal()};
}

Scan full_scan() {
  Scan scan;
  scan.name = "full";
  RandomStream random(5, 0, 0);
  for (int i = 0; i < 200; ++i) {
    scan.cloud.points.push_back(random_vector(random) * 1e6);
    scan.cloud.normals.push_back(i % 9 == 0 ? Eigen::Vector3d(0, 0, 0)
                                            : random_vector(random).normalized());
    scan.cloud.sigma_m.push_back(std::abs(random.normal()) * 1e-5);
    const Eigen::Vector3d v = random_vector(random);
    scan.cloud.covariances.push_back(v * v.transpose());
    scan.cloud.intensity.push_back(random.uniform());
    scan.ray.push_back(static_cast<std::uint32_t>(i * 3));
  }
  scan.grid = {30, 20};
  scan.misses = {{"no signal", 390}, {"out of range", 10}};
  scan.viewpoint = {0.1, -1.0 / 3, 1e7};
  scan.noise_window = {7, 5};
  Vector6 twist;
  twist << 0.3, -2, 1, 0.1, 1e3, 1e-9;
  scan.world_from_scanner_guess = exp(twist);
  scan.guess_sigma = {1.0 / 300, 2e-3};
  return scan;
}

void expect_same_cloud(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.sigma_m, b.sigma_m);
  EXPECT_EQ(a.covariances, b.covariances);
  EXPECT_EQ(a.intensity, b.intensity);
}

TEST(ScanFile, PlyBringsBackEverythingToTheBit) {
  const TemporaryFolder folder;
  const Scan scan = full_scan();
  write_scan(folder / "full.ply", scan);
  const Scan back = read_scan(folder / "full.ply");
  EXPECT_EQ(back.name, scan.name);
  expect_same_cloud(back.cloud, scan.cloud);
  EXPECT_EQ(back.ray, scan.ray);
  EXPECT_EQ(back.grid.rows, scan.grid.rows);
  EXPECT_EQ(back.grid.columns, scan.grid.columns);
  EXPECT_EQ(back.misses, scan.misses);
  EXPECT_EQ(back.viewpoint, scan.viewpoint);
  EXPECT_EQ(back.noise_window.rows, 7u);
  EXPECT_EQ(back.noise_window.columns, 5u);
  EXPECT_EQ(back.world_from_scanner_guess.matrix(), scan.world_from_scanner_guess.matrix());
  ASSERT_TRUE(back.guess_sigma);
  EXPECT_EQ(back.guess_sigma->rotation_rad, 1.0 / 300);
  EXPECT_EQ(back.guess_sigma->translation_m, 2e-3);
}

TEST(ScanFile, PlyOfPointsAloneBringsBackPointsAlone) {
  const TemporaryFolder folder;
  Scan scan;
  scan.cloud.points = {{1, 2, 3}, {-0.0, 0.1, 1e-300}};
  write_scan(folder / "points.ply", scan);
  const Scan back = read_scan(folder / "points.ply");
  expect_same_cloud(back.cloud, scan.cloud);
  EXPECT_TRUE(back.ray.empty());
  EXPECT_TRUE(back.misses.empty());
  EXPECT_EQ(back.viewpoint, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(back.noise_window.rows, 1u);
  scan.noise_window = {1, 5};
  write_scan(folder / "row.ply", scan);
  EXPECT_EQ(read_scan(folder / "row.ply").noise_window.columns, 5u);
}

TEST(ScanFile, PcdAndXyzBringBackPointsNormalsAndIntensityToTheBit) {
  const TemporaryFolder folder;
  Scan scan = full_scan();
  scan.cloud.sigma_m.clear();
  scan.cloud.covariances.clear();
  for (const char* name : {"a.pcd", "a.xyz", "a.txt", "a.asc"}) {
    write_scan(folder / name, scan);
    expect_same_cloud(read_scan(folder / name).cloud, scan.cloud);
  }
}

TEST(ScanFile, DropsAndCountsPointsThatAreNotFinite) {
  const TemporaryFolder folder;
  Scan scan = full_scan();
  scan.cloud.points[3].y() = std::nan("");
  scan.cloud.points[7].x() = std::numeric_limits<double>::infinity();
  scan.cloud.normals[9].z() = std::nan("");  // the point stays, its normal becomes unknown
  write_scan(folder / "holes.ply", scan);
  const Scan back = read_scan(folder / "holes.ply");
  ASSERT_EQ(back.cloud.size(), 198u);
  EXPECT_EQ(back.misses.at("not finite"), 2u);
  EXPECT_EQ(back.ray[3], scan.ray[4]);
  EXPECT_EQ(back.ray[6], scan.ray[8]);
  EXPECT_EQ(back.cloud.normals[7], Eigen::Vector3d(0, 0, 0));
}

TEST(ScanFile, RefusesFilesWithoutAValidPointAndUnknownEndings) {
  const TemporaryFolder folder;
  write_file(folder / "nan.xyz", "nan 0 0\n0 inf 0\n");
  EXPECT_NE(error_of([&] { read_scan(folder / "nan.xyz"); }).find("holds no valid point"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read_scan(folder / "missing.ply"); }).find("no such file"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read_scan(folder / "a.doc"); }).find("'.doc'"), std::string::npos);
  EXPECT_NE(
      error_of([&] { write_scan(folder / "a.doc", full_scan()); }, Trouble::output).find("'.doc'"),
      std::string::npos);
  EXPECT_NE(error_of([&] { write_scan(folder / "no" / "a.ply", full_scan()); }, Trouble::output)
                .find("cannot be written"),
            std::string::npos);
}

TEST(ScanFile, RefusesAViewpointAndAWindowThatAreNone) {
  const TemporaryFolder folder;
  for (const char* viewpoint : {"0 0", "0 0 x", "0 nan 0"}) {
    write_file(folder / "v.ply", std::string("ply\nformat ascii 1.0\ncomment libscan viewpoint ") +
                                     viewpoint +
                                     "\nelement vertex 1\nproperty float x\nproperty float y\n"
                                     "property float z\nend_header\n0 0 1\n");
    EXPECT_NE(error_of([&] { read_scan(folder / "v.ply"); }).find("'libscan viewpoint'"),
              std::string::npos)
        << viewpoint;
  }
  for (const char* window : {"0 3", "3", "x 1"}) {
    write_file(folder / "w.ply",
               std::string("ply\nformat ascii 1.0\ncomment libscan noise_window ") + window +
                   "\nelement vertex 1\nproperty float x\nproperty float y\n"
                   "property float z\nend_header\n0 0 1\n");
    EXPECT_NE(error_of([&] { read_scan(folder / "w.ply"); }).find("comment 'libscan"),
              std::string::npos)
        << window;
  }
}

TEST(ScanFile, RefusesUncertaintyThatIsNone) {
  const TemporaryFolder folder;
  Scan scan = full_scan();
  scan.cloud.sigma_m[5] = -1;
  write_scan(folder / "sigma.ply", scan);
  EXPECT_NE(error_of([&] { read_scan(folder / "sigma.ply"); }).find("point 5: sigma_m is -1"),
            std::string::npos);
}

const std::string grid_head =
    "ply\nformat ascii 1.0\nobj_info num_cols 3\nobj_info num_rows 2\nelement vertex 3\n"
    "property float x\nproperty float y\nproperty float z\nelement range_grid 6\n"
    "property list uchar int vertex_indices\nend_header\n0 0 1\n1 0 1\n2 0 1\n";

TEST(RangeGrid, GivesEachVertexItsRay) {
  const TemporaryFolder folder;
  write_file(folder / "grid.ply", grid_head + "0\n1 1\n1 0\n0\n0\n1 2\n");
  const Scan scan = read_scan(folder / "grid.ply");
  EXPECT_EQ(scan.grid.rows, 2u);
  EXPECT_EQ(scan.grid.columns, 3u);
  EXPECT_EQ(scan.ray, (std::vector<std::uint32_t>{2, 1, 5}));
  EXPECT_EQ(scan.misses.at("not recorded"), 3u);
}

// Those scanners look along -z: the sensor is far up the z axis.
TEST(RangeGrid, IsSeenFromFarUpTheZAxis) {
  const TemporaryFolder folder;
  write_file(folder / "grid.ply", grid_head + "0\n1 1\n1 0\n0\n0\n1 2\n");
  EXPECT_EQ(read_scan(folder / "grid.ply").viewpoint, Eigen::Vector3d(0, 0, 100));
}

TEST(RangeGrid, RefusesImpossibleCells) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& cells) {
    write_file(folder / "grid.ply", grid_head + cells);
    return error_of([&] { read_scan(folder / "grid.ply"); });
  };
  EXPECT_NE(said("0\n1 1\n1 0\n0\n0\n1 3\n").find("'range_grid', row 5: vertex 3, there are 3"),
            std::string::npos);
  EXPECT_NE(said("0\n1 1\n1 1\n0\n0\n1 2\n").find("row 2: vertex 1 is named twice"),
            std::string::npos);
  EXPECT_NE(said("0\n1 1\n2 0 1\n0\n0\n1 2\n").find("row 2: names more than one"),
            std::string::npos);
}

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1.0 / 3, 0, 1e6}, {0, 0.1, 0}, {0, 0, 1e-7}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(MeshFile, PlyObjAndOffBringBackDoublesToTheBit) {
  const TemporaryFolder folder;
  for (const char* name : {"t.ply", "t.obj", "t.off", "T.PLY"}) {
    write_mesh(folder / name, tetrahedron());
    const Mesh back = read_mesh(folder / name);
    EXPECT_EQ(back.vertices, tetrahedron().vertices) << name;
    EXPECT_EQ(back.triangles, tetrahedron().triangles) << name;
    EXPECT_TRUE(holds_triangles(folder / name));
  }
}

TEST(MeshFile, StlIsWeldedAndRoundsToFloat) {
  const TemporaryFolder folder;
  write_mesh(folder / "t.stl", tetrahedron());
  const Mesh back = read_mesh(folder / "t.stl");
  ASSERT_EQ(back.vertices.size(), 4u);
  EXPECT_TRUE(edge_census(back).watertight);
  for (std::size_t t = 0; t < 4; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(back.vertices[back.triangles[t][k]],
                tetrahedron().vertices[tetrahedron().triangles[t][k]].cast<float>().cast<double>());
}

TEST(MeshFile, PointsAloneAreNoMesh) {
  const TemporaryFolder folder;
  write_scan(folder / "points.ply", full_scan());
  EXPECT_FALSE(holds_triangles(folder / "points.ply"));
  EXPECT_FALSE(holds_triangles(folder / "points.xyz"));
  for (const char* points : {"points.ply", "points.xyz"}) {
    EXPECT_FALSE(lists_no_face(folder / points)) << points;
    EXPECT_FALSE(is_emptied_surface(folder / points)) << points;
  }
  EXPECT_NE(error_of([&] { read_mesh(folder / "points.ply"); }).find("holds no triangle"),
            std::string::npos);
}

}  // namespace
}  // namespace scan
