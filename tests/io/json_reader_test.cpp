// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/json_reader.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/core/units.h"
#include "tests/io/io_test_support.h"

namespace scan {
namespace {

using nlohmann::json;

TEST(JsonReader, ConvertsEachUnitAtTheBorder) {
  const json object = {{"a_mm", 2}, {"b_m", 2},    {"c_um", 2},        {"d_deg", 180},
                       {"e_ns", 3}, {"f_mhz", 20}, {"g_mm", {1, 2, 3}}};
  JsonReader reader(object, "a.json");
  EXPECT_EQ(reader.length_m("a"), 0.002);
  EXPECT_EQ(reader.length_m("b"), 2);
  EXPECT_EQ(reader.length_m("c"), 2e-6);
  EXPECT_EQ(reader.angle_rad("d"), std::numbers::pi);
  EXPECT_EQ(reader.time_s("e"), 3 * 1e-9);
  EXPECT_EQ(reader.frequency_hz("f"), 20e6);
  EXPECT_EQ(reader.vector_m("g"), Eigen::Vector3d(1, 2, 3) * 1e-3);
  EXPECT_EQ(reader.length_m("missing", 7), 7);
  reader.finish();
}

TEST(JsonReader, RefusesUnknownKeysWithTheNearestAsHint) {
  const json object = {{"radius_mm", 1}, {"radius_um", 1}, {"heigth_mm", 2}};
  JsonReader reader(object, "a.json/shape");
  reader.length_m("height", 1);
  try {
    reader.finish();
    ADD_FAILURE() << "an unknown key was taken";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "a.json/shape/heigth_mm: unknown key");
    EXPECT_EQ(error.hint(), "did you mean 'height_mm'?");
  }
  EXPECT_EQ(error_of([&] { reader.length_m("radius"); }),
            "a.json/shape/radius_um: is given in two units");
}

TEST(JsonReader, NamesPlaceAndValueOfWrongTypes) {
  const json object = {{"n", "five"},   {"i", 1.5}, {"t", 3},        {"b", 1},
                       {"v", {1, "x"}}, {"o", 4},   {"w_mm", {1, 2}}};
  JsonReader reader(object, "a.json");
  EXPECT_EQ(error_of([&] { reader.number("n"); }), "a.json/n: must be a number, is \"five\"");
  EXPECT_EQ(error_of([&] { reader.integer("i"); }), "a.json/i: must be a whole number, is 1.5");
  EXPECT_EQ(error_of([&] { reader.text("t"); }), "a.json/t: must be a text, is 3");
  EXPECT_EQ(error_of([&] { reader.boolean("b", true); }), "a.json/b: must be true or false, is 1");
  EXPECT_EQ(error_of([&] { reader.numbers("v"); }),
            "a.json/v: must hold finite numbers only, has \"x\"");
  EXPECT_EQ(error_of([&] { reader.object("o"); }),
            "a.json/o: must be an object { ... }, is number");
  EXPECT_EQ(error_of([&] { reader.vector_m("w"); }), "a.json/w: must have three numbers, has 2");
  EXPECT_EQ(error_of([&] { reader.number("missing"); }), "a.json/missing: is missing");
}

// A key that reads nearly like the missing one, with or without its unit.
TEST(JsonReader, NamesWhatWasMeantByAMistypedKey) {
  const json mistyped = {{"focal_pix", 3}, {"radus_mm", 2}, {"kind", 1}};
  JsonReader reader(mistyped, "a.json");
  EXPECT_EQ(hint_of([&] { reader.number("focal_px"); }), "did you mean 'focal_px' by 'focal_pix'?");
  EXPECT_EQ(hint_of([&] { reader.length_m("radius"); }), "did you mean 'radius_mm' by 'radus_mm'?");
  EXPECT_EQ(hint_of([&] { reader.number("weight"); }), "");
  reader.number("kind");
  EXPECT_EQ(hint_of([&] { reader.number("kinds"); }), "") << "a key that was asked for is right";
}

TEST(JsonReader, TakesExactlyOneOfSeveralKeys) {
  const nlohmann::json one = {{"area", 1}}, two = {{"area", 1}, {"point", 1}}, none = {{"pont", 1}};
  const std::vector<std::string> words = {"point", "area"};
  EXPECT_EQ(JsonReader(one, "a").one_of(words), "area");
  EXPECT_NE(error_of([&] { JsonReader(two, "a").one_of(words); }).find("a/area: stands beside"),
            std::string::npos);
  EXPECT_EQ(error_of([&] { JsonReader(none, "a").one_of(words); }),
            "a: must have one of point, area");
  EXPECT_EQ(hint_of([&] { JsonReader(none, "a").one_of(words); }),
            "did you mean 'point' by 'pont'?");
}

// A number that no `long` holds would come back as another one.
TEST(JsonReader, RefusesWholeNumbersBeyondItsRange) {
  const json object = {{"i", 18446744073709551615ull}};
  JsonReader reader(object, "a.json");
  EXPECT_NE(error_of([&] { reader.integer("i"); }).find("a.json/i: "), std::string::npos);
}

TEST(JsonReader, TurnsAboutTheAxesInTheirOrder) {
  const json object = {{"position_mm", {1, 0, 0}}, {"rotation_deg", {90, 90, 0}}};
  JsonReader reader(object, "a.json");
  // about x: y -> z, then about y: z -> x
  EXPECT_LT((reader.placement() * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(1.001, 0, 0)).norm(),
            1e-15);
}

TEST(JsonReader, NamesTheLineOfASyntaxError) {
  const TemporaryFolder folder;
  write_file(folder / "a.json", "{\n  // a comment\n  \"a\": 1,\n  \"b\": ]\n}\n");
  EXPECT_NE(error_of([&] { read_json(folder / "a.json"); }).find("near line 4"), std::string::npos);
  write_file(folder / "a.json", "{} {}");
  error_of([&] { read_json(folder / "a.json"); });
  write_file(folder / "a.json", "{\"x\": 1e999}");
  error_of([&] { read_json(folder / "a.json"); });
  write_file(folder / "a.json", std::string(200000, '[') + std::string(200000, ']'));
  EXPECT_NE(error_of([&] { read_json(folder / "a.json"); }).find("deeper than 256"),
            std::string::npos);
}

TEST(WriteFile, LeavesTheOldOrTheNewWhole) {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  write_file(folder / "a", std::string("new\0!", 5));
  EXPECT_EQ(read_file(folder / "a"), std::string("new\0!", 5));
  error_of([&] { write_file(folder / "no" / "a", "x"); }, Trouble::output);
  error_of([&] { write_file(folder.path(), "x"); }, Trouble::output);  // a folder stands there
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
    ++files;
  EXPECT_EQ(files, 1u);  // no temporary file is left
  EXPECT_FALSE(
      std::filesystem::exists(folder.path().string() + ".part" + std::to_string(::getpid())));
}

TEST(ReadFile, NamesTheFileAndItsTrouble) {
  const TemporaryFolder folder;
  EXPECT_NE(error_of([&] { read_file(folder / "a"); }).find("no such file"), std::string::npos);
  EXPECT_NE(error_of([&] { read_file(folder.path()); }).find("is a folder"), std::string::npos);
  write_file(folder / "a", "12345");
  EXPECT_NE(
      error_of([&] { read_file(folder / "a", 4); }, Trouble::resource).find("over the limit of 4"),
      std::string::npos);
  write_file(folder / "empty", "");
  EXPECT_EQ(read_file(folder / "empty"), "");
}

TEST(Fingerprint, IsTheOneOfFnv) {
  EXPECT_EQ(fingerprint(""), "cbf29ce484222325");  // published test vectors of FNV-1a, 64 bits
  EXPECT_EQ(fingerprint("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(fingerprint("foobar"), "85944171f73967e8");
}

}  // namespace
}  // namespace scan
