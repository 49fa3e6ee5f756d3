// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/mesh_text.h"

#include <gtest/gtest.h>

#include "tests/io/io_test_support.h"

namespace scan {
namespace {

const std::string obj =
    "# by hand\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0.123456789012345678\nv 0 1 0\n"
    "vt 0 0\nvn 0 0 1\nusemtl red\nf 1/1/1 2//1 3/1 \\\n 4\nf -4 -2 -1\nl 1 2\n";

TEST(Obj, ReadsPolygonsBackwardIndicesAndContinuedLines) {
  const Mesh mesh = parse_obj(obj, "a.obj").mesh;
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[2].z(), 0.123456789012345678);  // to the last digit of a double
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 2, 3}}));
}

// OBJ counts v upwards, TextureCorners downwards; fans share their first corner.
TEST(Obj, KeepsTextureCoordinatesIfAllFacesHaveThem) {
  const std::string quad =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0.25\nvt 1 0.25\nvt 1 1\nvt 0 1 0\n"
      "f 1/1 2/2/7 3/3 4/-1\n";
  const TexturedMesh textured = parse_obj(quad, "a.obj");
  ASSERT_EQ(textured.corners.size(), 2u);
  EXPECT_EQ(textured.corners[0][0], Eigen::Vector2d(0, 0.75));
  EXPECT_EQ(textured.corners[0][2], Eigen::Vector2d(1, 0));
  EXPECT_EQ(textured.corners[1][0], Eigen::Vector2d(0, 0.75));
  EXPECT_EQ(textured.corners[1][2], Eigen::Vector2d(0, 0));
  EXPECT_TRUE(parse_obj(quad + "f 1//1 2//1 3//1\n", "a.obj").corners.empty());
  EXPECT_TRUE(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "a.obj").corners.empty());
  EXPECT_NE(error_of([&] {
              parse_obj(quad + "f 1/9 2/1 3/1\n", "a.obj");
            }).find("line 10: texture coordinate 9, there are 4"),
            std::string::npos);
}

TEST(Obj, NamesTheLineOfWhatIsBroken) {
  const auto said = [](const std::string& text) {
    return error_of([&] { parse_obj(text, "a.obj"); });
  };
  EXPECT_EQ(said("v 0 0 0\nf 1 2 3\n"), "a.obj: line 2: vertex 2, there are 1");
  EXPECT_EQ(said("v 0 0 0\nf 0 1 1\n"), "a.obj: line 2: vertex 0, there are 1");
  EXPECT_EQ(said("v 0 0 0\nf -2 1 1\n"), "a.obj: line 2: vertex -2, there are 1");
  EXPECT_EQ(said("v 0 x 0\n"), "a.obj: line 1: 'x' is no coordinate");
  EXPECT_EQ(said("v 0 nan 0\n"), "a.obj: line 1: 'nan' is no coordinate");
  EXPECT_EQ(said("v 0 0 0\nf 1 1\n"), "a.obj: line 2: a face has fewer than three corners");
}

const std::string off =
    "OFF\n# by hand\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0.1\n\n4 0 1 2 3\n3 0 1 2 255 0 0\n";

TEST(Off, ReadsHeadersOfEachKind) {
  const Mesh mesh = parse_off(off, "a.off");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(mesh.vertices[3].z(), 0.1);
  EXPECT_EQ(parse_off("OFF 1 0 0\n1 2 3\n", "a.off").vertices.size(), 1u);
  EXPECT_EQ(parse_off("OFF1 0 0\n1 2 3\n", "a.off").vertices.size(), 1u);
  EXPECT_EQ(parse_off("COFF\n1 0 0\n1 2 3 255 0 0 255\n", "a.off").vertices[0],
            Eigen::Vector3d(1, 2, 3));
}

TEST(Off, NamesTheLineOfWhatIsBroken) {
  const auto said = [](const std::string& text) {
    return error_of([&] { parse_off(text, "a.off"); });
  };
  EXPECT_EQ(said("PLY\n"), "a.off: line 1: is not an OFF file (its first line is not 'OFF')");
  EXPECT_EQ(said("4OFF\n"), "a.off: line 1: is not an OFF file (its first line is not 'OFF')");
  EXPECT_EQ(said("OFF BINARY\n"), "a.off: line 1: binary OFF is not understood");
  EXPECT_EQ(said("OFF\n4000000000 1 0\n0 0 0\n"),
            "a.off: line 3: the file ends where vertex 1 should be");
  EXPECT_EQ(said("OFF\n1 1 0\n0 0 0\n3 0 0 1\n"), "a.off: line 4: vertex 1, there are 1");
  EXPECT_EQ(said("OFF\n1 1 0\n0 0 0\n4000000000 0\n"),
            "a.off: line 4: the line ends before its 4000000000 corners");
  EXPECT_EQ(said("OFF\n1 0 0\n0 0 0\n1 1 1\n"),
            "a.off: line 4: data behind the last face that the header promises");
}

const std::string stl =
    "solid by hand\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
    "0.1\nendloop\n"
    "endfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 "
    "0.1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 1 0 -0\nvertex 0 1 "
    "0.1\nendloop\nendfacet\nendsolid\n";

TEST(Stl, WeldsEqualVerticesAndDropsWhatIsNoTriangle) {
  const Mesh mesh = parse_stl(stl, "a.stl");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(Stl, BinaryThatBeginsWithSolidIsBinary) {
  std::string bytes = stl_bytes({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  ASSERT_EQ(bytes.size(), 134u);
  bytes.replace(0, 5, "solid");
  EXPECT_EQ(parse_stl(bytes, "a.stl").triangles.size(), 1u);
  // the normal is that of the corners' order
  EXPECT_EQ(bytes.substr(92, 4), std::string("\x00\x00\x80\x3f", 4));
}

TEST(Stl, RefusesLyingCountsAndNumbersThatAreNone) {
  std::string bytes = stl_bytes({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  bytes[80] = '\xff', bytes[83] = '\xff';
  EXPECT_NE(error_of([&] { parse_stl(bytes, "a.stl"); }).find("do not fit its count"),
            std::string::npos);
  bytes = stl_bytes({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  bytes[98] = '\x80', bytes[99] = '\x7f';
  EXPECT_EQ(error_of([&] { parse_stl(bytes, "a.stl"); }),
            "a.stl: triangle 0 has a coordinate that is not finite");
  EXPECT_NE(error_of([&] {
              stl_bytes({{{1e39, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
            }).find("1e+39"),
            std::string::npos);
}

TEST(MeshText, ReadsOrRefusesAnyDamage) {
  const auto checked = [](const Mesh& mesh) { check(mesh); };
  expect_read_or_refused(
      obj, 5000, [&](const std::string& bytes) { checked(parse_obj(bytes, "d.obj").mesh); });
  expect_read_or_refused(off, 5000,
                         [&](const std::string& bytes) { checked(parse_off(bytes, "d.off")); });
  expect_read_or_refused(stl, 5000,
                         [&](const std::string& bytes) { checked(parse_stl(bytes, "d.stl")); });
  expect_read_or_refused(stl_bytes(parse_stl(stl, "a.stl")), 5000,
                         [&](const std::string& bytes) { checked(parse_stl(bytes, "d.stl")); });
}

}  // namespace
}  // namespace scan
