// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The schema and the reader know the same recipes: what is shipped or written keeps the schema, and
// no key that the schema has is unknown to the reader.
#include "tools/recipe_schema.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "libscan/core/error.h"
#include "libscan/io/json_reader.h"
#include "tests/tools/json_schema.h"
#include "tools/recipe.h"

namespace scan::test {
namespace {

const json& schema() {
  static const json value = recipe_schema();
  return value;
}

json small_recipe() {
  return read_json(LIBSCAN_SOURCE_DIR "/tests/tools/small_run.json");
}

std::vector<std::filesystem::path> shipped_recipes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(LIBSCAN_SOURCE_DIR "/datasets"))
    if (entry.path().extension() == ".json" && read_json(entry.path()).contains("libscan"))
      paths.push_back(entry.path());
  return paths;
}

TEST(RecipeSchema, TakesEveryShippedRecipeAsItStandsAndAsItIsWrittenBack) {
  const auto paths = shipped_recipes();
  ASSERT_GE(paths.size(), 20u);
  for (const auto& path : paths) {
    EXPECT_EQ(broken(schema(), read_json(path), schema()), "") << path;
    EXPECT_EQ(broken(schema(), json(to_json(read_recipe(path))), schema()), "") << path;
  }
}

// What the reader says of a recipe that keeps the schema; empty if it takes it. Values may be
// refused, files may be missing, but no key may be unknown, missing or of the wrong kind.
std::string complaint(const json& recipe) {
  try {
    const Recipe read = read_recipe(recipe, "recipe.json", LIBSCAN_SOURCE_DIR);
    const std::string why = broken(schema(), json(to_json(read)), schema());
    return why.empty() ? "" : "written back it breaks the schema: " + why;
  } catch (const Error& error) {
    return error.what();
  }
}

bool is_about_keys(const std::string& complaint) {
  for (const char* words : {"unknown key", "is missing", "breaks the schema", "exactly one of",
                            "must have one of", "must be a number", "must be a list",
                            "must be an object", "must be a text", "must be a whole number"})
    if (complaint.find(words) != std::string::npos) return true;
  return false;
}

TEST(RecipeSchema, HasNoKeyThatTheReaderDoesNotKnow) {
  int tried = 0, taken = 0;
  for (const auto& [part, of_part] : schema()["properties"].items()) {
    const Values values = values_of(of_part, schema());
    std::vector<json> all = values.more;
    all.push_back(values.least);
    for (const json& value : all) {
      json recipe = small_recipe();
      recipe[part] = value;
      // The scene's parts are read in the order materials, objects, lights: what an invented part
      // lacks is lent by the small recipe's, lest an earlier trouble hide a later key.
      if (part == "scene" && !value["materials"].contains("clay"))
        recipe[part]["materials"]["clay"] = {{"diffuse", 0.6}};
      ASSERT_EQ(broken(of_part, value, schema()), "") << part << ": " << value;
      const std::string said = complaint(recipe);
      EXPECT_FALSE(is_about_keys(said)) << said << "\n" << part << ": " << value;
      ++tried;
      taken += said.empty() ? 1 : 0;
    }
  }
  // Numbers are made up: many a one is refused for its value (a window of 1 px, a sphere around the
  // scanner), which hides nothing of the keys since an object's keys are judged before its values.
  EXPECT_GT(tried, 400);
  EXPECT_GT(taken, tried / 2) << "of " << tried;
}

// A default that is told under a key of another unit would be another value.
TEST(RecipeSchema, TellsTheDefaultsThatTheReaderFillsIn) {
  for (const char* part : {"align", "reconstruct", "verify"}) {
    json silent = small_recipe();
    silent[part] = json::object();
    json spoken = silent;
    for (const auto& [key, property] : schema()["properties"][part]["properties"].items())
      if (property.contains("default")) spoken[part][key] = property["default"];
    ASSERT_GE(spoken[part].size(), 3u) << part;
    const auto as_read = [](const json& recipe) {
      return json(to_json(read_recipe(recipe, "recipe.json", LIBSCAN_SOURCE_DIR)));
    };
    EXPECT_EQ(as_read(spoken), as_read(silent)) << part;
  }
}

TEST(RecipeSchema, RefusesWhatTheReaderRefuses) {
  const json good = small_recipe();
  ASSERT_EQ(broken(schema(), good, schema()), "");
  const auto refused = [&](const char* pointer, const json& value) {
    json recipe = good;
    recipe[json::json_pointer(pointer)] = value;
    EXPECT_NE(broken(schema(), recipe, schema()), "") << pointer << " " << value;
    EXPECT_NE(complaint(recipe), "") << pointer << " " << value;
  };
  refused("/sede", 3);
  refused("/libscan", 2);
  refused("/seed", -1);
  refused("/scene/objects", json::array());
  refused("/scene/objects/0/shape", "bucket");
  refused("/scene/objects/0/shape", {{"sphere", {{"radius_mm", 1}, {"radius_m", 1}}}});
  refused("/scene/materials/paint", {{"diffuse", 0.5}, {"plastic", "window"}});
  refused("/reconstruct/method", "sdd");
  refused("/align/max_distance", 3);
  refused("/limits", {{{"name", "accuracy_rms"}, {"at_most_mm", 1}}});
  refused("/tradeoff", {{"vary", json::array()}});
}

}  // namespace
}  // namespace scan::test
