// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/shape_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/io/io_test_support.h"

namespace scan {
namespace {

Shape parse(const std::string& text) {
  const auto document = nlohmann::json::parse(text);
  JsonReader reader(document, "shape.json");
  return read_shape(reader);
}

Pose pose() {
  Vector6 twist;
  twist << 0.1, -0.7, 2, 1.0 / 3, -5, 1e-9;
  return exp(twist);
}

// Walks the variant: a new kind must be written and read back as itself.
std::vector<Shape> one_of_each() {
  CombinedShape inner{
      CombinedShape::Operation::intersect, 0, {{Pose::Identity(), SphereShape{0.1}}}};
  CombinedShape outer{CombinedShape::Operation::subtract,
                      1.0 / 7,
                      {{pose(), BoxShape{{0.1, 1.0 / 3, 2}, 0.01}}, {pose().inverse(), inner}}};
  return {PlaneShape{},
          SphereShape{1.0 / 3},
          CylinderShape{0.1, 0.7},
          BoxShape{{0.3, 0.2, 0.1}, 0.05},
          TorusShape{0.3, 0.1},
          outer};
}

TEST(ShapeJson, BringsBackEachShapeToTheBit) {
  const auto shapes = one_of_each();
  ASSERT_EQ(shapes.size(), std::variant_size_v<Shape>);
  for (std::size_t kind = 0; kind < shapes.size(); ++kind) {
    ASSERT_EQ(shapes[kind].index(), kind);
    const std::string text = to_json(shapes[kind]).dump();
    const Shape back = parse(text);
    EXPECT_EQ(back.index(), kind);
    EXPECT_EQ(to_json(back).dump(),
              text);  // as numbers are written exactly, equal text is equal bits
    RandomStream random(1, 0, kind);
    for (int i = 0; i < 50; ++i) {
      const double x = random.normal(), y = random.normal();
      const Eigen::Vector3d at(x, y, random.normal());
      EXPECT_EQ(field(back, at).value_m, field(shapes[kind], at).value_m);
    }
  }
}

TEST(ShapeJson, ReadsTheKeysOfTheHeader) {
  EXPECT_EQ(std::get<SphereShape>(parse(R"({"sphere":{"radius_mm":25}})")).radius_m, 0.025);
  const auto box = std::get<BoxShape>(parse(R"({"box":{"size_mm":[40,30,20],"rounding_mm":2}})"));
  EXPECT_EQ(box.size_m, Eigen::Vector3d(40, 30, 20) * 1e-3);
  const auto joined = std::get<CombinedShape>(parse(
      R"({"unite":{"blend_mm":3,"parts":[{"shape":{"plane":{}},"position_mm":[0,0,5],"rotation_deg":[90,0,0]}]}})"));
  EXPECT_EQ(joined.blend_m, 0.003);
  // a quarter turn about x carries z to -y
  EXPECT_LT(
      (joined.parts[0].parent_from_shape * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(0, -1, 0.005))
          .norm(),
      1e-15);
}

TEST(ShapeJson, NamesThePlaceOfWhatIsBroken) {
  const auto said = [](const std::string& text) { return error_of([&] { parse(text); }); };
  EXPECT_NE(said(R"({"sphere":{"radius_mm":-1}})").find("shape.json/sphere: sphere: radius"),
            std::string::npos);
  EXPECT_NE(said(R"({"sphere":{"radius":1}})").find("shape.json/sphere/radius: is missing"),
            std::string::npos);
  EXPECT_NE(said(R"({"sphere":{"radius_mm":1,"radius_m":1}})").find("two units"),
            std::string::npos);
  EXPECT_NE(said(R"({"sphere":{},"box":{}})").find("has 2"), std::string::npos);
  EXPECT_EQ(said(R"({"shpere":{"radius_mm":1}})"), "shape.json/shpere: unknown shape");
  EXPECT_NE(said(R"({"unite":{"parts":[{"shape":{"sphere":{"radius_mm":0}}}]}})")
                .find("/unite/parts/0/shape/sphere"),
            std::string::npos);
  EXPECT_NE(said(R"({"unite":{"parts":[]}})").find("no parts"), std::string::npos);
  std::string deep = R"({"sphere":{"radius_mm":1}})";
  for (int i = 0; i < 200; ++i) deep = R"({"unite":{"parts":[{"shape":)" + deep + "}]}}";
  EXPECT_NE(said(deep).find("nested deeper"), std::string::npos);
}

TEST(PoseJson, RefusesWhatIsNoPose) {
  const auto said = [](const std::string& text) {
    return error_of([&] { pose_from_json(nlohmann::json::parse(text), "here"); });
  };
  EXPECT_NE(said("[1,2]").find("here: must be a 4x4 matrix"), std::string::npos);
  EXPECT_NE(said("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,null]]").find("row 3, column 3"),
            std::string::npos);
  EXPECT_NE(said("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]").find("last row"), std::string::npos);
  EXPECT_NE(said("[[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]").find("away from a rotation"),
            std::string::npos);
}

}  // namespace
}  // namespace scan
