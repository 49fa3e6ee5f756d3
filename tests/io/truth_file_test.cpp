// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/truth_file.h"

#include <gtest/gtest.h>

#include "libscan/io/scan_file.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

Truth example() {
  Truth truth;
  truth.surface.shapes.push_back(
      {make_pose(Eigen::Matrix3d::Identity(), {0.1, 0, 0}), SphereShape{1.0 / 3}});
  truth.surface.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1.0 / 3, 0}}, {{0, 1, 2}}});
  for (int i = 0; i < 2; ++i) {
    ScanTruth scan;
    scan.world_from_scanner = make_pose(Eigen::Matrix3d::Identity(), {0, 0.1 * i, -1});
    scan.rays.resize(3);
    scan.rays[1] = {{1.0 / 3, 0, i + 0.1}, {0, 0, -1}, 4};
    truth.scans.push_back(scan);
  }
  return truth;
}

void write(const std::filesystem::path& folder, const Truth& truth) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < truth.scans.size(); ++i) {
    write_true_rays(folder, i, truth.scans[i].rays);
    poses.push_back(truth.scans[i].world_from_scanner);
  }
  write_true_scene(folder, truth.surface, poses);
}

TEST(TruthFile, BringsBackSurfacePosesAndRays) {
  const TemporaryFolder folder;
  const Truth truth = example();
  write(folder.path(), truth);
  const Truth back = read_truth(folder.path());
  ASSERT_EQ(back.surface.shapes.size(), 1u);
  EXPECT_EQ(std::get<SphereShape>(back.surface.shapes[0].shape).radius_m, 1.0 / 3);
  EXPECT_EQ(back.surface.shapes[0].parent_from_shape.matrix(),
            truth.surface.shapes[0].parent_from_shape.matrix());
  ASSERT_EQ(back.surface.meshes.size(), 1u);
  EXPECT_EQ(back.surface.meshes[0].vertices, truth.surface.meshes[0].vertices);
  ASSERT_EQ(back.scans.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.scans[i].name, i == 0 ? "000" : "001");
    EXPECT_EQ(back.scans[i].world_from_scanner.matrix(),
              truth.scans[i].world_from_scanner.matrix());
    ASSERT_EQ(back.scans[i].rays.size(), 3u);
    EXPECT_EQ(back.scans[i].rays[1].point_in_scanner, truth.scans[i].rays[1].point_in_scanner);
    EXPECT_EQ(back.scans[i].rays[1].normal_in_scanner, truth.scans[i].rays[1].normal_in_scanner);
    EXPECT_EQ(back.scans[i].rays[1].object, 4);
    EXPECT_EQ(back.scans[i].rays[0].object, -1);
    EXPECT_TRUE(back.scans[i].rays[0].point_in_scanner.array().isNaN().all());
  }
}

TEST(TruthFile, TakesAMeshAsSurfaceAndRefusesAnEmptyOne) {
  const TemporaryFolder folder;
  write_mesh(folder / "part.obj", example().surface.meshes[0]);
  EXPECT_EQ(read_true_surface(folder / "part.obj").meshes.size(), 1u);
  write_file(folder / "empty.json", "{\"shapes\": []}");
  EXPECT_NE(
      error_of([&] { read_true_surface(folder / "empty.json"); }).find("neither shapes nor meshes"),
      std::string::npos);
  write_file(folder / "typo.json", "{\"shape\": []}");
  EXPECT_NE(error_of([&] { read_true_surface(folder / "typo.json"); }).find("/shape: unknown key"),
            std::string::npos);
}

TEST(TruthFile, NamesTheMissingFile) {
  const TemporaryFolder folder;
  write(folder.path(), example());
  std::filesystem::remove(folder / "001.ply");
  EXPECT_NE(error_of([&] { read_truth(folder.path()); }).find("001.ply: no such file"),
            std::string::npos);
}

}  // namespace
}  // namespace scan
