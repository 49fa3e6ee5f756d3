// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/ply.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "libscan/core/cost.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

constexpr PlyEncoding encodings[] = {PlyEncoding::ascii, PlyEncoding::binary_little_endian,
                                     PlyEncoding::binary_big_endian};

template <class Number>
std::vector<Number> extremes() {
  using Limits = std::numeric_limits<Number>;
  return {Number{0},     Number{1},     Limits::lowest(),
          Limits::max(), Limits::min(), static_cast<Number>(Limits::max() / 3)};
}

// Every scalar type as scalar and as list, with its extreme values; lists of 0 to 3 entries.
Ply ply_of_every_type() {
  Ply ply;
  ply.comments = {"made for a test", "with two comments"};
  ply.obj_info = {"num_cols 3"};
  PlyElement scalars{"scalars", 6, {}}, lists{"lists", 4, {}};
  const auto add = [&]<class Number>(const char* name, Number) {
    scalars.properties.push_back({name, extremes<Number>(), {}, false});
    lists.properties.push_back({name, extremes<Number>(), {1, 0, 3, 2}, true});
  };
  add("char", std::int8_t{});
  add("uchar", std::uint8_t{});
  add("short", std::int16_t{});
  add("ushort", std::uint16_t{});
  add("int", std::int32_t{});
  add("uint", std::uint32_t{});
  add("float", float{});
  add("double", double{});
  ply.elements = {scalars, lists, {"nothing", 0, {}}};
  return ply;
}

// Bit by bit, so that -0 is not 0 and a NaN is itself.
void expect_same(const Ply& a, const Ply& b) {
  EXPECT_EQ(a.comments, b.comments);
  EXPECT_EQ(a.obj_info, b.obj_info);
  ASSERT_EQ(a.elements.size(), b.elements.size());
  for (std::size_t e = 0; e < a.elements.size(); ++e) {
    EXPECT_EQ(a.elements[e].name, b.elements[e].name);
    EXPECT_EQ(a.elements[e].count, b.elements[e].count);
    ASSERT_EQ(a.elements[e].properties.size(), b.elements[e].properties.size());
    for (std::size_t p = 0; p < a.elements[e].properties.size(); ++p) {
      const PlyProperty &x = a.elements[e].properties[p], &y = b.elements[e].properties[p];
      EXPECT_EQ(x.name, y.name);
      EXPECT_EQ(x.is_list, y.is_list);
      EXPECT_EQ(x.lengths, y.lengths);
      ASSERT_EQ(x.values.index(), y.values.index());
      std::visit(
          [&]<class Numbers>(const Numbers& numbers) {
            const auto& others = std::get<Numbers>(y.values);
            ASSERT_EQ(numbers.size(), others.size());
            EXPECT_EQ(std::memcmp(numbers.data(), others.data(),
                                  numbers.size() * sizeof(typename Numbers::value_type)),
                      0)
                << x.name;
          },
          x.values);
    }
  }
}

TEST(Ply, KeepsEveryTypeListAndCommentInEveryEncoding) {
  const Ply ply = ply_of_every_type();
  for (const PlyEncoding encoding : encodings)
    expect_same(parse_ply(ply_bytes(ply, encoding), "test.ply"), ply);
}

TEST(Ply, KeepsDoublesOfAnyBitPatternInText) {
  RandomStream random(3, 0, 0);
  PlyElement element{"vertex", 5000, {}};
  std::vector<double> numbers(element.count);
  for (double& number : numbers) {
    const auto bits = std::uint64_t{random.bits32()} << 32 | random.bits32();
    std::memcpy(&number, &bits, sizeof number);
    if (number != number) number = -0.0;  // text has no payload of a NaN
  }
  element.properties.push_back({"x", numbers, {}, false});
  const Ply ply{{}, {}, {element}};
  expect_same(parse_ply(ply_bytes(ply, PlyEncoding::ascii), "test.ply"), ply);
}

TEST(Ply, ReadsListsLongerThan255) {
  PlyElement element{"strip", 2, {}};
  element.properties.push_back(
      {"vertex_indices", std::vector<std::int32_t>(301, 7), {300, 1}, true});
  const Ply ply{{}, {}, {element}};
  for (const PlyEncoding encoding : encodings)
    expect_same(parse_ply(ply_bytes(ply, encoding), "test.ply"), ply);
}

// Written by hand from the format's description (Turk 1994).
const std::string square =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty float32 "
    "y\n"
    "property double z\nproperty uchar red\nelement face 1\nproperty list uchar int "
    "vertex_indices\n"
    "end_header\n0 0 0.1 255\n1 0 0.1 0\n\n1 1 0.1 7\n0 1 0.1 8\n4 0 1 2 3\n";

TEST(Ply, ReadsAFileWrittenByHand) {
  const Ply ply = parse_ply(square, "square.ply");
  EXPECT_EQ(ply.comments, std::vector<std::string>{"by hand"});
  EXPECT_EQ(ply.find("vertex")->numbers("red"), (std::vector<double>{255, 0, 7, 8}));
  EXPECT_EQ(ply.find("vertex")->numbers("z")[0], 0.1);  // a double, not a float
  const Mesh mesh = mesh_from(ply, "square.ply");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(1, 1, 0.1));
}

TEST(Ply, ReadsBigEndianBytesWrittenByHand) {
  const std::string bytes = std::string(
                                "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty "
                                "short a\nproperty float b\n"
                                "property list uchar ushort c\nend_header\n") +
                            std::string("\xff\xfe\x3f\x80\x00\x00\x02\x00\x01\x01\x00", 11);
  const Ply ply = parse_ply(bytes, "big.ply");
  EXPECT_EQ(ply.find("vertex")->numbers("a"), std::vector<double>{-2});
  EXPECT_EQ(ply.find("vertex")->numbers("b"), std::vector<double>{1});
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(ply.find("vertex")->find("c")->values),
            (std::vector<std::uint16_t>{1, 256}));
}

TEST(Ply, TakesHeaderLinesOfAllThreeEndings) {
  // the first byte of the row is a line feed: it must not be taken for a part of the header
  const std::string head =
      "ply|format binary_little_endian 1.0|element v 1|property uchar a|"
      "property uchar b|end_header|";
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string bytes;
    for (const char c : head) bytes += c == '|' ? end : std::string(1, c);
    const Ply ply = parse_ply(bytes + "\n\x05", "ends.ply");
    EXPECT_EQ(ply.find("v")->numbers("a"), std::vector<double>{10});
    EXPECT_EQ(ply.find("v")->numbers("b"), std::vector<double>{5});
  }
  std::string windows;
  for (const char c : square) windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_same(parse_ply(windows, "square.ply"), parse_ply(square, "square.ply"));
}

struct BrokenCase {
  const char* what;
  std::string bytes;
  const char* said;  // part of the message
};

std::string with_header(const std::string& lines, const std::string& data = "") {
  return "ply\nformat ascii 1.0\n" + lines + "end_header\n" + data;
}

TEST(Ply, NamesWhatIsBrokenAndWhere) {
  const std::string xyz = "element vertex 2\nproperty float x\nproperty int y\n";
  const BrokenCase cases[] = {
      {"empty", "", "first line is not 'ply'"},
      {"other file", "PNG\n", "first line is not 'ply'"},
      {"no end_header", "ply\nformat ascii 1.0\nelement vertex 2\n", "ends before 'end_header'"},
      {"format", "ply\nformat binary 1.0\nend_header\n", "unknown format 'binary'"},
      {"no format", "ply\nelement vertex 2\nend_header\n", "must be 'format"},
      {"version", "ply\nformat ascii 2.0\nend_header\n", "version must be 1.0"},
      {"type", with_header("element v 1\nproperty real x\n", "1\n"), "line 4: unknown type 'real'"},
      {"float length", with_header("element v 1\nproperty list float int x\n", "1 1\n"),
       "length of a list"},
      {"count", with_header("element v -1\nproperty int x\n"), "count is '-1'"},
      {"orphan", with_header("property int x\n"), "property before any element"},
      {"twice", with_header("element v 0\nproperty int x\nproperty int x\n"), "property 'x' twice"},
      {"keyword", with_header("elment v 0\n"), "unknown keyword 'elment'"},
      {"no property", with_header("element v 3\n"), "3 rows but no property"},
      {"short row", with_header(xyz, "1 2\n3333\n"), "element 'vertex', property 'y', row 1"},
      {"long row", with_header(xyz, "1 2\n3 4 5\n"), "row 1: more values than properties: '5'"},
      {"missing row", with_header(xyz, "1 222222222222\n"), "row 0: '222222222222'"},
      {"file ends", with_header(xyz, "1.00000000 2\n"), "row 1: the file ends here"},
      {"not a number", with_header(xyz, "1 2\nx 4\n"), "property 'x', row 1: 'x'"},
      {"fraction", with_header(xyz, "1 2\n1 0.5\n"), "property 'y', row 1: '0.5'"},
      {"behind", with_header(xyz, "1 2\n3 4\n5 6\n"), "behind the last row"},
      {"list length", with_header("element f 1\nproperty list char int i\n", "-1\n"),
       "length of a list is -1"},
      {"list end", with_header("element f 1\nproperty list uchar int i\n", "3 1 2\n"), "row 0"},
      {"list lies", with_header("element f 1\nproperty list uint int i\n", "4000000000 1\n"),
       "4000000000 entries"},
  };
  for (const BrokenCase& broken : cases) {
    const std::string said = error_of([&] { parse_ply(broken.bytes, "broken.ply"); });
    EXPECT_NE(said.find("broken.ply: "), std::string::npos) << broken.what << ": " << said;
    EXPECT_NE(said.find(broken.said), std::string::npos) << broken.what << ": " << said;
  }
}

TEST(Ply, RefusesLyingCountsBeforeAllocating) {
  const double before_mib = peak_memory_mib();
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* count : {"4000000000", "18446744073709551615"})
      for (const char* property : {"double x", "list uint double x"}) {
        const std::string bytes = std::string("ply\nformat ") + format + " 1.0\nelement vertex " +
                                  count + "\nproperty " + property +
                                  "\nend_header\n1 2 3 4 5 6 7 8\n";
        EXPECT_NE(error_of([&] { parse_ply(bytes, "lie.ply"); }).find("header promises"),
                  std::string::npos);
      }
  const std::string list = std::string(
                               "ply\nformat binary_little_endian 1.0\nelement f 1\n"
                               "property list uint double i\nend_header\n") +
                           std::string("\xff\xff\xff\xff........", 12);
  EXPECT_NE(error_of([&] { parse_ply(list, "lie.ply"); }).find("4294967295 entries"),
            std::string::npos);
  EXPECT_LT(peak_memory_mib() - before_mib, 16);  // one honest allocation would take 30 GiB
}

TEST(Ply, ReadsOrRefusesAnyDamage) {
  for (const PlyEncoding encoding : encodings)
    expect_read_or_refused(ply_bytes(ply_of_every_type(), encoding), 4000,
                           [](const std::string& bytes) {
                             const Ply ply = parse_ply(bytes, "damaged.ply");
                             cloud_from(ply, "damaged.ply");
                             mesh_from(ply, "damaged.ply");
                           });
  expect_read_or_refused(square, 10000, [](const std::string& bytes) {
    check(mesh_from(parse_ply(bytes, "damaged.ply"), "damaged.ply"));
  });
}

TEST(Ply, RefusesToWriteWhatCannotBeRead) {
  PlyElement uneven{"vertex", 2, {{"x", std::vector<float>{1}, {}, false}}};
  EXPECT_NE(error_of([&] {
              ply_bytes({{}, {}, {uneven}});
            }).find("1 rows, the element has 2"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              ply_bytes({{"two\nlines"}, {}, {}});
            }).find("line break"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              ply_bytes({{}, {}, {{"two words", 0, {}}}});
            }).find("not one word"),
            std::string::npos);
}

TEST(Ply, NamesAMissingCoordinateAndAnImpossibleCorner) {
  const Ply flat =
      parse_ply(with_header("element vertex 1\nproperty int x\nproperty int y\n", "1 2\n"), "f");
  EXPECT_NE(error_of([&] {
              cloud_from(flat, "flat.ply");
            }).find("flat.ply: element 'vertex' has no property 'z'"),
            std::string::npos);
  std::string wrong = square;
  wrong.replace(wrong.find("4 0 1 2 3"), 9, "4 0 1 2 4");
  EXPECT_NE(error_of([&] {
              mesh_from(parse_ply(wrong, "w"), "wrong.ply");
            }).find("vertex 4, there are 4"),
            std::string::npos);
}

}  // namespace
}  // namespace scan
