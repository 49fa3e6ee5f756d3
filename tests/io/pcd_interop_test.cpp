// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PCL as the oracle of our PCD reader and writer.
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include "libscan/io/pcd.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

pcl::PointCloud<pcl::PointXYZINormal> pcl_cloud() {
  pcl::PointCloud<pcl::PointXYZINormal> cloud;
  RandomStream random(8, 0, 0);
  for (int i = 0; i < 3000; ++i) {
    pcl::PointXYZINormal p;
    p.x = static_cast<float>(random.normal());
    p.y = static_cast<float>(i % 10);  // repeats, so that compression has something to do
    p.z = 1;
    p.normal_x = 0, p.normal_y = 0, p.normal_z = 1;
    p.intensity = static_cast<float>(i / 100);
    cloud.push_back(p);
  }
  return cloud;
}

TEST(PcdInterop, ReadsWhatPclWritesInEachPacking) {
  const TemporaryFolder folder;
  const auto original = pcl_cloud();
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeASCII((folder / "ascii.pcd").string(), original, 9), 0);
  ASSERT_EQ(writer.writeBinary((folder / "binary.pcd").string(), original), 0);
  ASSERT_EQ(writer.writeBinaryCompressed((folder / "compressed.pcd").string(), original), 0);
  for (const char* name : {"ascii.pcd", "binary.pcd", "compressed.pcd"}) {
    const PointCloud cloud = read_pcd(folder / name);
    ASSERT_EQ(cloud.size(), original.size()) << name;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_EQ(cloud.points[i], original[i].getVector3fMap().cast<double>()) << name;
      EXPECT_EQ(cloud.normals[i], Eigen::Vector3d(0, 0, 1)) << name;
      EXPECT_EQ(cloud.intensity[i], original[i].intensity) << name;
    }
  }
}

TEST(PcdInterop, DamagedCompressedFilesAreReadOrRefused) {
  const TemporaryFolder folder;
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeBinaryCompressed((folder / "c.pcd").string(), pcl_cloud()), 0);
  const std::string good = read_file(folder / "c.pcd");
  for (int flip = 0; flip < 1000; ++flip) {
    RandomStream random(9, 0, static_cast<std::uint64_t>(flip));
    std::string bytes = good;
    bytes[random.bits32() % bytes.size()] = static_cast<char>(random.bits32());
    write_file(folder / "d.pcd", bytes);
    try {
      read_pcd(folder / "d.pcd");
    } catch (const Error&) {
    }
  }
}

TEST(PcdInterop, PclReadsOurDoublesAsFields) {
  const TemporaryFolder folder;
  PointCloud cloud;
  cloud.points = {{0.1, 0.2, 0.3}, {1e6 + 0.001, 2, 3}};
  write_pcd(folder / "a.pcd", cloud);
  pcl::PCLPointCloud2 blob;
  ASSERT_EQ(pcl::PCDReader().read((folder / "a.pcd").string(), blob), 0);
  ASSERT_EQ(blob.width * blob.height, 2u);
  EXPECT_EQ(blob.fields[0].datatype, pcl::PCLPointField::FLOAT64);
  double x;
  std::memcpy(&x, blob.data.data() + blob.point_step, sizeof x);
  EXPECT_EQ(x, 1e6 + 0.001);
}

}  // namespace
}  // namespace scan
