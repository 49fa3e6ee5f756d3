// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Files of others, read as their makers describe them.
#include <gtest/gtest.h>

#include "libscan/io/scan_file.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

TEST(RealData, TheTenBunnyScansHaveTheirPublishedPoints) {
  const auto folder = outside_data() / "stanford-bunny" / "data";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the Stanford bunny is not in " << folder;
  std::size_t points = 0;
  for (const char* name : {"bun000", "bun045", "bun090", "bun180", "bun270", "bun315", "top2",
                           "top3", "chin", "ear_back"}) {
    const Scan scan = read_scan(folder / (std::string(name) + ".ply"));
    EXPECT_EQ(scan.name, name);
    EXPECT_EQ(scan.grid.rows, 400u);
    EXPECT_EQ(scan.grid.columns, 512u);
    EXPECT_EQ(scan.ray.size(), scan.cloud.size());
    EXPECT_EQ(scan.cloud.size() + scan.misses.at("not recorded"), 204800u);
    points += scan.cloud.size();
  }
  EXPECT_EQ(points, 362272u);  // the number that Stanford publishes
}

// Columns step 0.5 mm in x; other rows are shifted by half a column (the data's README): a ray
// index that is one column or row off would break this.
TEST(RealData, BunnyRaysFollowTheirColumns) {
  const auto file = outside_data() / "stanford-bunny" / "data" / "bun000.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the Stanford bunny is not at " << file;
  const Scan scan = read_scan(file);
  for (std::size_t i = 1; i < scan.cloud.size(); ++i) {
    const std::uint32_t row = scan.ray[i] / 512, before = scan.ray[i - 1] / 512;
    if (row != before) continue;
    const double columns = static_cast<double>(scan.ray[i]) - scan.ray[i - 1];
    // six digits in the file: 1e-7 m at 0.1 m
    EXPECT_NEAR(scan.cloud.points[i].x() - scan.cloud.points[i - 1].x(), 0.0005 * columns, 2e-7);
  }
}

TEST(RealData, MeshesHaveTheirKnownCounts) {
  const auto data = outside_data();
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "the outside data is not in " << data;
  const Mesh bunny = read_mesh(data / "stanford-bunny" / "reconstruction" / "bun_zipper.ply");
  EXPECT_EQ(bunny.vertices.size(), 35947u);
  EXPECT_EQ(bunny.triangles.size(), 69451u);
  EXPECT_EQ(edge_census(bunny).boundary_edges, 223u);
  const Mesh anchor = read_mesh(data / "reconbench" / "mesh" / "anchor.off");
  EXPECT_EQ(anchor.vertices.size(), 49200u);
  EXPECT_EQ(edge_census(anchor).genus, 4);
  EXPECT_NEAR(volume_m3(anchor), 60350, 0.5);  // published to a whole number
  const Mesh spot = read_mesh(data / "spot" / "spot_triangulated.obj");
  EXPECT_EQ(spot.vertices.size(), 2930u);
  EXPECT_EQ(spot.triangles.size(), 5856u);
  EXPECT_TRUE(edge_census(spot).watertight);
  EXPECT_GT(read_mesh(data / "cornell-box" / "cornell_box.obj").triangles.size(), 20u);
}

TEST(RealData, LidarAndSimulatedCloudsRead) {
  const auto data = outside_data();
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "the outside data is not in " << data;
  const Scan source = read_scan(data / "lidar-small_gicp" / "source.ply");
  EXPECT_EQ(source.cloud.size(), 69792u);
  EXPECT_EQ(source.cloud.intensity.size(), 69792u);
  const Scan derived = read_scan(data / "reconbench" / "derived" / "anchor_mvs_full.ply");
  const Scan original = read_scan(data / "reconbench" / "scan" / "anchor_mvs.npz");
  ASSERT_EQ(derived.cloud.size(), 3000u);
  ASSERT_EQ(original.cloud.size(), 3000u);
  for (std::size_t i = 0; i < 3000; ++i)  // the derived file holds the same numbers as floats
    EXPECT_EQ(derived.cloud.points[i].cast<float>(), original.cloud.points[i].cast<float>());
}

}  // namespace
}  // namespace scan
