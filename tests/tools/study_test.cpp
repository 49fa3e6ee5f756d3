// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Studies: what they vary, over what grid, and which seconds they count.
#include "tools/study.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/core/error.h"

namespace scan {
namespace {

Study study_of(const char* text) {
  const nlohmann::json json = nlohmann::json::parse(text);
  return read_study(JsonReader(json, "test.json/tradeoff"));
}

Study three_by_two() {
  return study_of(R"({"vary": [{"key": "reconstruct/depth", "values": [5, 6, 7]},
                               {"key": "align/method", "values": ["symmetric", "plane-to-plane"]}],
                      "seeds": 2, "error": "accuracy_mean"})");
}

TEST(Study, IsReadAndItsGridHasEverySetting) {
  const Study study = three_by_two();
  EXPECT_EQ(study.seeds, 2);
  EXPECT_EQ(study.error, "accuracy_mean");
  const auto settings = grid(study);
  ASSERT_EQ(settings.size(), 6u);
  EXPECT_EQ(settings[1], (Setting{0, 1}));
  EXPECT_EQ(setting_json(study, settings[5]).dump(),
            R"({"reconstruct/depth":7,"align/method":"plane-to-plane"})");
}

TEST(Study, PutsValuesInTheirPlaces) {
  const nlohmann::json recipe = {{"reconstruct", {{"depth", 8}, {"trim_mm", 1}}}};
  const StudyRecipe changed = with_setting(recipe, three_by_two(), Case(), {0, 1});
  EXPECT_EQ(changed.recipe.dump(),
            R"({"align":{"method":"plane-to-plane"},"reconstruct":{"depth":5,"trim_mm":1}})");
  EXPECT_EQ(changed.threads, 0);
  const Study wrong = study_of(R"({"vary": [{"key": "reconstruct/depth/x", "values": [1]}]})");
  EXPECT_THROW(with_setting(recipe, wrong, Case(), {0}), Error);
}

// A choice may set many fields, a case is set first, and threads are no part of the recipe.
TEST(Study, HasChoicesOfManyFieldsCasesAndThreads) {
  const Study study = study_of(R"({
      "vary": [{"name": "scanner", "choices": [
                  {"name": "near", "set": {"scanner": {"a": 1}, "viewpoints/dome/count": 6}},
                  {"name": "far", "set": {"scanner": {"b": 2}}}]},
               {"key": "threads", "values": [1, 2]}],
      "cases": [{"name": "clean", "set": {"effects": "none"}},
                {"name": "few", "set": {"viewpoints/dome/count": 3}}],
      "seconds": "align"})");
  ASSERT_EQ(study.cases.size(), 2u);
  const nlohmann::json recipe = {{"scanner", {{"c", 3}}}};
  const StudyRecipe clean = with_setting(recipe, study, study.cases[0], {0, 1});
  EXPECT_EQ(clean.recipe.dump(),
            R"({"effects":"none","scanner":{"a":1},"viewpoints":{"dome":{"count":6}}})");
  EXPECT_EQ(clean.threads, 2);
  const StudyRecipe few = with_setting(recipe, study, study.cases[1], {1, 0});
  EXPECT_EQ(few.recipe.dump(), R"({"scanner":{"b":2},"viewpoints":{"dome":{"count":3}}})");
  EXPECT_EQ(few.threads, 1);
  EXPECT_EQ(setting_json(study, {1, 0}).dump(), R"({"scanner":"far","threads":1})");
  const Study none = study_of(R"({"vary": [{"key": "threads", "values": [0]}]})");
  EXPECT_THROW(with_setting(recipe, none, none.cases[0], {0}), Error);
}

TEST(Study, CountsTheSecondsOfItsStage) {
  const StageCosts stages = {{"simulate", {.seconds = 3}}, {"align", {.seconds = 2}}};
  EXPECT_EQ(seconds_of(study_of(R"({"vary": [{"key": "a", "values": [1]}]})"), stages), 5);
  EXPECT_EQ(seconds_of(study_of(R"({"vary": [{"key": "a", "values": [1]}], "seconds": "align"})"),
                       stages),
            2);
}

TEST(Study, RefusesWhatItCannotVary) {
  for (const char* broken :
       {R"({})", R"({"vary": []})", R"({"vary": [{"key": "a", "values": []}]})",
        R"({"vary": [{"key": "a", "values": 3}]})",
        R"({"vary": [{"key": "a", "values": [1]}, {"key": "a", "values": [2]}]})",
        R"({"vary": [{"key": "a", "values": [1]}], "seeds": 0})",
        R"({"vary": [{"key": "a", "values": [1]}], "sedes": 2})",
        R"({"vary": [{"key": "a", "values": [1]}], "seconds": "alin"})",
        R"({"vary": [{"name": "a", "choices": []}]})",
        R"({"vary": [{"name": "a", "choices": [{"name": "b", "set": {}}]}]})",
        R"({"vary": [{"name": "a", "choices": [{"name": "b", "set": 3}]}]})",
        R"({"vary": [{"name": "a", "choices": [{"name": "b", "sett": {"c": 1}}]}]})",
        R"({"vary": [{"key": "a", "values": [1]}], "cases": []})",
        R"({"vary": [{"key": "a", "values": [1]}], "cases": [
            {"name": "b", "set": {"c": 1}}, {"name": "b", "set": {"c": 2}}]})"})
    EXPECT_THROW(study_of(broken), Error) << broken;
}

TEST(Study, CountsTheProcessorsSecondsIfAsked) {
  const StageCosts stages = {{"align", {.seconds = 2, .processor_seconds = 5}}};
  const Study study = study_of(R"({"vary": [{"key": "a", "values": [1]}], "clock": "processor"})");
  EXPECT_EQ(seconds_of(study, stages), 5);
  EXPECT_EQ(seconds_text(study), "processor seconds");
  EXPECT_THROW(study_of(R"({"vary": [{"key": "a", "values": [1]}], "clock": "sun"})"), Error);
}

}  // namespace
}  // namespace scan
