// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/pcd.h"

#include <gtest/gtest.h>

#include "libscan/core/cost.h"
#include "libscan/io/lzf.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

std::string pcd(const std::string& points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb intensity\nSIZE 4 8 4 4 2\nTYPE F F F U U\n"
         "COUNT 1 1 1 2 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data;
}

PointCloud read_bytes(const TemporaryFolder& folder, const std::string& bytes) {
  write_file(folder / "a.pcd", bytes);
  return read_pcd(folder / "a.pcd");
}

TEST(Pcd, ReadsAFileWrittenByHand) {
  const TemporaryFolder folder;
  const PointCloud cloud =
      read_bytes(folder, pcd("2", "ascii\n0.1 0.1 3 7 7 65535\n4 nan 6 7 7 0\n"));
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.points[0].x(), 0.1f);  // a float in the file
  EXPECT_EQ(cloud.points[0].y(), 0.1);   // a double in the file
  EXPECT_EQ(cloud.intensity, (std::vector<double>{65535, 0}));
  EXPECT_TRUE(std::isnan(cloud.points[1].y()));
}

TEST(Pcd, ReadsBinaryWrittenByHand) {
  const TemporaryFolder folder;
  const std::string record(
      "\x00\x00\x80\x3f"
      "\x00\x00\x00\x00\x00\x00\x00\x40"
      "\x00\x00\x40\x40"
      "........"
      "\x01\x02",
      26);
  const PointCloud cloud = read_bytes(folder, pcd("1", "binary\n" + record));
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cloud.intensity[0], 513);
}

TEST(Pcd, NamesWhatIsBroken) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& bytes) {
    return error_of([&] { read_bytes(folder, bytes); });
  };
  EXPECT_NE(said("ply\n").find("unknown keyword 'ply'"), std::string::npos);
  EXPECT_NE(said("VERSION 0.7\n").find("ends before 'DATA'"), std::string::npos);
  EXPECT_NE(said(pcd("1", "ascii\n1 2 x 7 7 0\n")).find("PCD point 0, field 'z': 'x'"),
            std::string::npos);
  EXPECT_NE(said(pcd("2", "ascii\n1 2 3 7 7 0                    \n"))
                .find("promises 2 points, it has 1"),
            std::string::npos);
  EXPECT_NE(said(pcd("1", "text\n")).find("DATA must be"), std::string::npos);
  EXPECT_NE(said("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nPOINTS 1\nDATA ascii\n1 2\n")
                .find("no field 'z'"),
            std::string::npos);
  EXPECT_NE(said("FIELDS x\nSIZE 3\nTYPE F\nCOUNT 1\nPOINTS 1\nDATA ascii\n1\n")
                .find("type F of 3 bytes"),
            std::string::npos);
}

TEST(Pcd, RefusesLyingCountsBeforeAllocating) {
  const TemporaryFolder folder;
  const double before_mib = peak_memory_mib();
  for (const char* data : {"ascii\n1 2 3 7 7 0\n", "binary\n12345678",
                           "binary_compressed\n\x08\0\0\0\xff\xff\xff\xff"})
    error_of([&] { read_bytes(folder, pcd("4000000000", data)); });
  const std::string block(
      "\x08\x00\x00\x00\xff\xff\xff\xff"
      "12345678",
      16);
  EXPECT_NE(error_of([&] {
              read_bytes(folder, pcd("1", "binary_compressed\n" + block));
            }).find("damaged"),
            std::string::npos);
  EXPECT_LT(peak_memory_mib() - before_mib, 16);
}

TEST(Pcd, ReadsOrRefusesAnyDamage) {
  const TemporaryFolder folder;
  PointCloud cloud;
  cloud.points = {{1, 2, 3}, {4, 5, 6}};
  cloud.normals = {{0, 0, 1}, {0, 1, 0}};
  cloud.intensity = {7, 8};
  write_pcd(folder / "good.pcd", cloud);
  for (const std::string& good :
       {read_file(folder / "good.pcd"), pcd("2", "ascii\n0.1 0.1 3 7 7 65535\n4 5 6 7 7 0\n")})
    expect_read_or_refused(good, 2000,
                           [&](const std::string& bytes) { read_bytes(folder, bytes); });
}

// By hand: three literals "abc", then a copy of six from distance 3 that overlaps itself.
TEST(Lzf, CopiesMayOverlapThemselves) {
  const std::string packed(
      "\x02"
      "abc"
      "\x80\x02",
      6);
  EXPECT_EQ(lzf_decompressed(packed, 9), "abcabcabc");
  EXPECT_EQ(lzf_decompressed(packed, 8), std::nullopt);
  EXPECT_EQ(lzf_decompressed(packed, 10), std::nullopt);
  EXPECT_EQ(lzf_decompressed(std::string("\x80\x02", 2), 6),
            std::nullopt);  // copies from before the start
  EXPECT_EQ(lzf_decompressed("abc", std::size_t{1} << 40), std::nullopt);
}

}  // namespace
}  // namespace scan
