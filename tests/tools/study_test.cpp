// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Studies: their grid, their front, their advice, and the search that takes a short cut to it.
#include "tools/study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "tools/study_search.h"

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

StudyPoint point(double error, double seconds) {
  return {.runs = 1, .error = error, .seconds = seconds};
}
const double failed = std::numeric_limits<double>::quiet_NaN();

TEST(Front, HoldsWhatNothingBeatsInBoth) {
  std::vector<StudyPoint> points = {point(3, 1), point(2, 2), point(2.5, 3), point(1, 4),
                                    point(failed, 0.1)};
  mark_front(points);
  const std::vector<bool> wanted = {true, true, false, true, false};
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i].on_front, wanted[i]) << i;
}

TEST(Advice, IsTheCheapestWithinTheToleranceOrTheBest) {
  const std::vector<StudyPoint> points = {point(3, 1), point(2, 2), point(1.9, 3),
                                          point(failed, 0)};
  EXPECT_EQ(advised(points, 2), 1u);
  EXPECT_EQ(advised(points, 5), 0u);
  EXPECT_EQ(advised(points, 1), 2u);
  EXPECT_EQ(advised(points, 0), 2u);
  EXPECT_FALSE(advised(std::vector<StudyPoint>{point(failed, 1)}, 2));
}

// Errors and seconds that each field changes by a factor of its own, as accuracy and cost usually
// do, with 1 % of chance per seed: over 50 random studies of 4 x 4 x 3 settings and three seeds the
// short cut advises what the grid advises in a fifth of the runs. Where the two differ, chance
// alone decides: what it gives is within the tolerance by its own runs, and it costs more than the
// grid's advice only if that lies within 3 % of the tolerance.
TEST(AdaptiveSearch, AdvisesWhatTheGridAdvisesInAFifthOfTheRuns) {
  const Study study = study_of(R"({"vary": [{"key": "a", "values": [1, 2, 3, 4]},
      {"key": "b", "values": [1, 2, 3, 4]}, {"key": "c", "values": [1, 2, 3]}], "seeds": 3})");
  std::size_t grid_runs = 0, adaptive_runs = 0;
  int same = 0;
  for (std::uint64_t s = 0; s < 50; ++s) {
    RandomStream random(9, 0, s);
    double error_factor[3], cost_factor[3];
    for (int k = 0; k < 3; ++k) {
      error_factor[k] = 0.4 + 0.5 * random.uniform();
      cost_factor[k] = 1.2 + random.uniform();
    }
    std::size_t runs = 0;
    const Measure measure = [&](const Setting& setting, int seeds) {
      StudyPoint p{.setting = setting, .runs = static_cast<std::size_t>(seeds), .seconds = 1};
      double error = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        error *= std::pow(error_factor[k], static_cast<double>(setting[k]));
        p.seconds *= std::pow(cost_factor[k], static_cast<double>(setting[k]));
      }
      for (int i = 0; i < seeds; ++i) {
        RandomStream chance(s, setting[0] + 10 * setting[1] + 100 * setting[2],
                            static_cast<std::uint64_t>(i));
        p.error += error * (1 + 0.01 * chance.normal()) / seeds;
      }
      runs += static_cast<std::size_t>(seeds);
      return p;
    };
    const double tolerance = 0.3 * random.uniform() + 0.1;
    const auto all = search_grid(study, measure);
    grid_runs += runs;
    runs = 0;
    const auto tried = search_adaptively(study, tolerance, measure);
    adaptive_runs += runs;
    const StudyPoint wanted = all[*advised(all, tolerance)];
    const StudyPoint given = tried[*advised(tried, tolerance)];
    EXPECT_LE(given.error, std::max(tolerance, wanted.error)) << s;
    if (given.setting == wanted.setting) ++same;
    if (given.seconds > wanted.seconds) {
      EXPECT_GT(wanted.error, 0.97 * tolerance) << s;
    }
  }
  EXPECT_GE(same, 45);
  EXPECT_LE(5 * adaptive_runs, grid_runs);
}

// Grids of real recipes that ran once (datasets/studies/search), looked up instead of run again.
class RealGrid {
 public:
  explicit RealGrid(const std::string& name) {
    const std::string path = LIBSCAN_SOURCE_DIR "/datasets/studies/search/" + name;
    const nlohmann::json recipe = nlohmann::json::parse(std::ifstream(path + ".json"));
    study = read_study(JsonReader(recipe.at("tradeoff"), name));
    const nlohmann::json done = nlohmann::json::parse(std::ifstream(path + "-grid.json"));
    for (const auto& run : done.at("runs")) runs_[run.at("settings").dump()] = run.at("by_seed");
  }

  StudyPoint measure(const Setting& setting, int seeds) {
    const auto& by_seed = runs_.at(nlohmann::json(setting_json(study, setting)).dump());
    StudyPoint p{.setting = setting, .runs = static_cast<std::size_t>(seeds)};
    for (int i = 0; i < seeds; ++i) {
      const auto& error = by_seed.at("error_m").at(static_cast<std::size_t>(i));
      p.error += (error.is_number() ? error.get<double>() : failed) / seeds;
      p.seconds += by_seed.at("seconds").at(static_cast<std::size_t>(i)).get<double>() / seeds;
      looked_at.insert({setting, i});
    }
    return p;
  }

  Study study;
  std::set<std::pair<Setting, int>> looked_at;  // what would have run

 private:
  std::map<std::string, nlohmann::json> runs_;  // by their settings
};

// For tolerances from below the best error to above the worst: what the short cut advises is within
// the tolerance whenever the grid has such a setting, in a fifth of the grid's runs. It is the
// grid's advice at four fifths of them and more, and nowhere costs more than half as much again;
// settings that differ in what hardly changes the seconds (light, say) are near ties. The line
// printed has what was measured.
TEST(AdaptiveSearch, AdvisesWhatTheGridsOfRealRecipesAdvise) {
  for (const char* name : {"vessel-phase"}) {
    RealGrid real(name);
    const Measure measure = [&](const Setting& s, int seeds) { return real.measure(s, seeds); };
    const auto all = search_grid(real.study, measure);
    const std::size_t grid_runs = real.looked_at.size();
    std::vector<double> tolerances{0};
    for (const StudyPoint& p : all)
      if (std::isfinite(p.error)) tolerances.push_back(1.001 * p.error);
    std::size_t most_runs = 0, same = 0, as_cheap = 0;
    double dearest = 1;
    for (const double tolerance : tolerances) {
      real.looked_at.clear();
      const auto tried = search_adaptively(real.study, tolerance, measure);
      const StudyPoint wanted = all[*advised(all, tolerance)];
      const StudyPoint given = tried[*advised(tried, tolerance)];
      EXPECT_LE(given.error, std::max(tolerance, wanted.error)) << name << " " << tolerance;
      const double ratio = given.seconds / wanted.seconds;
      same += given.setting == wanted.setting;
      as_cheap += ratio <= 1.1;
      dearest = std::max(dearest, ratio);
      most_runs = std::max(most_runs, real.looked_at.size());
    }
    std::printf(
        "%-14s %3zu of %3zu runs at most; of %zu tolerances the same advice at %zu, within "
        "10 %% of its seconds at %zu, %.2f times them at most\n",
        name, most_runs, grid_runs, tolerances.size(), same, as_cheap, dearest);
    EXPECT_GE(static_cast<double>(same), 0.8 * static_cast<double>(tolerances.size())) << name;
    EXPECT_LE(dearest, 1.5) << name;
    EXPECT_LE(5 * most_runs, grid_runs) << name;
  }
}

}  // namespace
}  // namespace scan
