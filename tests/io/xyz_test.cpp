// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/xyz.h"

#include <gtest/gtest.h>

#include "tests/io/io_test_support.h"

namespace scan {
namespace {

TEST(Xyz, TakesCommasBlanksAndComments) {
  const PointCloud cloud = parse_xyz("// X Y Z\n# note\n1,2,3\r\n\n4\t5  6 # end\n7; 8;9", "a.xyz");
  EXPECT_EQ(cloud.points, (std::vector<Eigen::Vector3d>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
}

TEST(Xyz, KnowsNormalsAndIntensityByTheNumberOfColumns) {
  EXPECT_EQ(parse_xyz("1 2 3 0.5", "a").intensity, std::vector<double>{0.5});
  EXPECT_EQ(parse_xyz("1 2 3 0 0 1", "a").normals[0], Eigen::Vector3d(0, 0, 1));
  const PointCloud both = parse_xyz("1 2 3 0 0 1 9", "a");
  EXPECT_EQ(both.normals[0], Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(both.intensity[0], 9);
}

TEST(Xyz, NamesLineAndColumn) {
  const auto said = [](const std::string& text) {
    return error_of([&] { parse_xyz(text, "a.xyz"); });
  };
  EXPECT_EQ(said("1 2 3\n4 5,6 \n7 8 9x\n"), "a.xyz: line 3, column 3: '9x' is not a number");
  EXPECT_EQ(said("1 2 3\n4 5\n"), "a.xyz: line 2: has 2 numbers, the lines before have 3");
  EXPECT_EQ(said("# nothing\n"), "a.xyz: holds no point");
  EXPECT_NE(said("1 2 3 4 5\n").find("has 5 numbers a row"), std::string::npos);
}

TEST(Xyz, ReadsOrRefusesAnyDamage) {
  expect_read_or_refused("1.5 -2e-3 3 0 0 1 9\n1,2,3,0,0,1,9\n# end\n", 20000,
                         [](const std::string& bytes) { parse_xyz(bytes, "damaged.xyz"); });
}

}  // namespace
}  // namespace scan
