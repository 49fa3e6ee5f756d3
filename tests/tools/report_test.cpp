// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// `scan report`: the page, its twins, and what it makes of runs that are not whole.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/report_of.h"

namespace scan::test {
namespace {

constexpr int input = 3, usage = 2;

std::string without_scripts(std::string page) {
  for (auto at = page.find("<script"); at != std::string::npos; at = page.find("<script", at))
    page.erase(at, page.find("</script>", at) + 9 - at);
  return page;
}

TEST(Report, HasTheSameNumbersOnThePageAndInItsTwins) {
  const Folder folder;
  const Written report = report_of(small_run(), folder);
  ASSERT_EQ(report.outcome.exit_code, 0) << report.outcome.err;
  const auto verdict = ordered_json::parse(slurp(small_run() / "verdict.json"));
  EXPECT_EQ(report.twin.at("measurements"), verdict.at("measurements"));
  EXPECT_GT(verdict.at("measurements").size(), 20u);
  for (const auto& m : verdict.at("measurements")) {
    if (!m.at("value").is_number()) continue;
    EXPECT_TRUE(holds(report.page, "<data value=\"" + m.at("value").dump() + "\">")) << m;
    EXPECT_TRUE(holds(report.csv, "verdict," + m.at("name").get<std::string>() + "," +
                                      m.at("value").dump() + ","))
        << m;
  }
  const ordered_json& deviation = report.twin.at("deviation");
  for (const auto& [name, value] : deviation.at("statistics").items()) {
    EXPECT_TRUE(holds(report.csv, "deviation," + name + "," + value.dump() + ",")) << name;
    if (name.ends_with("_m")) {
      EXPECT_TRUE(holds(report.page, "<data value=\"" + value.dump() + "\">")) << name;
    }
  }
  for (const auto& place : deviation.at("call_outs"))
    for (const auto& coordinate : place.at("position_m"))
      EXPECT_TRUE(holds(report.page, "<data value=\"" + coordinate.dump() + "\">"));
  EXPECT_GE(deviation.at("call_outs").size(), 3u);
}

// Counts stand in full, effects that were left out are no part of what the run cost, and a colour
// scale's middle has no unit of its own.
TEST(Report, PrintsCountsInFullAndTellsCostsThatWereSpared) {
  const Folder folder;
  const Written report = report_of(small_run(), folder);
  const std::string triangles = report.twin.at("reconstruction").at("triangles").dump();
  EXPECT_TRUE(holds(report.page, "<dt>triangles</dt><dd><data value=\"" + triangles + "\">" +
                                     triangles + "</data></dd>"));
  for (const auto& effect : report.twin.at("effects")) {
    const std::string name = "<td>effect " + effect.at("effect").get<std::string>();
    EXPECT_FALSE(
        holds(report.page, name + (effect.at("decision") == "on" ? ", had" : ", estimated")))
        << effect;
  }
  EXPECT_TRUE(holds(report.page, ">0</text>"));
  EXPECT_FALSE(holds(report.page, ">0 m</text>"));
}

TEST(Report, OfARunIsThatOfTheFolder) {
  const Folder folder;
  const Written report = report_of(small_run(), folder);
  EXPECT_EQ(report.csv, slurp(small_run() / "report.csv"));
  EXPECT_EQ(report.twin, ordered_json::parse(slurp(small_run() / "report.json")));
  EXPECT_EQ(report.page, slurp(small_run() / "report.html"));
}

// The largest and the mean of what each scan is off by are the verdict's.
TEST(Report, TellsHowFarEachPoseIsOff) {
  const Folder folder;
  const Written report = report_of(small_run(), folder);
  const auto& errors = report.twin.at("pose_errors");
  ASSERT_EQ(errors.size(), report.twin.at("scans").size());
  double largest = 0, sum = 0;
  for (const auto& error : errors) {
    const double rms_m = error.at("rms_m");
    largest = std::max(largest, rms_m);
    sum += rms_m;
    EXPECT_TRUE(holds(report.csv, "pose_error," + error.at("file").get<std::string>() + "," +
                                      error.at("rms_m").dump() + ",m"));
    EXPECT_TRUE(holds(report.page, "<data value=\"" + error.at("translation_m").dump() + "\">"));
  }
  const auto figure = [&](const char* name) {
    for (const auto& m : report.twin.at("measurements"))
      if (m.at("name") == name) return m.at("value").get<double>();
    throw std::runtime_error(name);
  };
  EXPECT_EQ(figure("pose_error_rms"), largest);
  EXPECT_NEAR(figure("pose_error_rms_mean"), sum / static_cast<double>(errors.size()),
              1e-12 * largest);
  fs::remove_all(copy_of_run(folder) / "truth");
  const Written blind = report_of(folder / "run", folder);
  EXPECT_TRUE(blind.twin.at("pose_errors").empty());
  EXPECT_FALSE(holds(blind.page, "off, shift"));
}

TEST(Report, IsBelowTwoMegabytesAndLoadsNothing) {
  const std::string page = slurp(small_run() / "report.html");
  EXPECT_LT(page.size(), 2'000'000u);
  // Scripts aside, whose text is data here, every link stays on the page and every source is data.
  const std::string shown = without_scripts(page);
  for (const char* name : {" src=", " href=", " action=", " poster=", " srcset=", " data="})
    for (auto at = shown.find(name); at != std::string::npos; at = shown.find(name, at + 1)) {
      const std::string value = shown.substr(at + std::string(name).size() + 1, 22);
      EXPECT_TRUE(value.starts_with("data:image/png;base64,") || value.starts_with("#"))
          << name << value;
    }
  for (const char* word : {"<link", "<iframe", "<object", "<embed", "<base", "@import", "url("})
    EXPECT_FALSE(holds(page, word)) << word;
  EXPECT_TRUE(holds(page, "default-src 'none'"));
  EXPECT_TRUE(holds(page, "The MIT License"));
}

TEST(Report, PutsTheVerdictFirstAndGivesEachPartATitle) {
  const std::string page = slurp(small_run() / "report.html");
  const auto verdict = page.find("class=\"verdict ");
  EXPECT_LT(verdict, page.find("<nav"));
  auto before = verdict;
  for (const char* id : {"verdict", "map", "view", "histogram", "figures", "poses", "scans",
                         "effects", "cost", "provenance"}) {
    const auto at = page.find("<section id=\"" + std::string(id) + "\"");
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, before) << id;
    EXPECT_TRUE(holds(page, "<a href=\"#" + std::string(id) + "\"")) << id;
    before = at;
  }
  EXPECT_TRUE(holds(page, "Why this limit: One &lt;body&gt;, &quot;whole&quot;."));
  for (auto at = page.find("<img"); at != std::string::npos; at = page.find("<img", at + 1)) {
    const std::string tag = page.substr(at, page.find("src=", at) - at);
    const auto alt = tag.find(" alt=\"");
    ASSERT_NE(alt, std::string::npos);
    EXPECT_GT(tag.find('"', alt + 6) - alt, 16u) << tag;  // at least ten letters
  }
}

TEST(Report, ShowsTextOfARunAsTextOnly) {
  const Folder folder;
  const fs::path run = copy_of_run(folder);
  auto recipe = ordered_json::parse(slurp(run / "recipe.json"));
  recipe["name"] = "</script><script>alert(1)</script><img src=x onerror=alert(1)>";
  spill(run / "recipe.json", recipe.dump());
  const Written report = report_of(run, folder);
  ASSERT_EQ(report.outcome.exit_code, 0) << report.outcome.err;
  EXPECT_FALSE(holds(report.page, "<script>alert"));
  EXPECT_FALSE(holds(report.page, "<img src=x"));
  EXPECT_EQ(report.twin.at("title"), recipe["name"]);
}

TEST(Report, TellsThePosesWay) {
  const auto trace = ordered_json::parse(slurp(small_run() / "pose_trace.json"));
  const ordered_json& steps = trace.at("steps");
  ASSERT_GT(steps.size(), 4u);
  EXPECT_EQ(steps.front().at("step"), "guess");
  EXPECT_TRUE(steps.back().at("step").get<std::string>().starts_with("joint "));
  // poses.tum: time, then the same seven numbers; the last round is the answer.
  std::istringstream poses(slurp(small_run() / "poses.tum"));
  for (std::string comment; poses.peek() == '#';) std::getline(poses, comment);
  for (const auto& pose : steps.back().at("world_from_scan")) {
    double stamp = 0;
    poses >> stamp;
    std::vector<double> found(7);
    for (double& number : found) poses >> number;
    const auto traced = pose.get<std::vector<double>>();
    const double side = found[6] * traced[6] < 0 ? -1 : 1;  // q and -q are one rotation
    for (std::size_t k = 0; k < 7; ++k)
      EXPECT_NEAR(traced[k] * (k < 3 ? 1 : side), found[k], 1e-12);
  }
}

TEST(Report, OfARunCutShortNamesWhatIsMissing) {
  const struct {
    std::vector<std::string> gone;
    std::string says;
  } cases[] = {{{"verdict.json"}, "verdict.json is not there: nothing was verified"},
               {{"verdict.json", "surface.ply", "reconstruction.json"}, "surface.ply is not there"},
               {{"verdict.json", "surface.ply", "reconstruction.json", "poses.tum",
                 "alignment.json", "pose_trace.json"},
                "poses.tum is not there: the scans were not aligned"},
               {{"truth"}, "truth is not there: no deviation can be told"},
               {{"verdict.json", "surface.ply", "scans", "effects.json", "timings.json", "truth",
                 "alignment.json", "poses.tum"},
                "scans/000.ply is not there"}};
  for (const auto& one : cases) {
    const Folder folder;
    const fs::path run = copy_of_run(folder);
    for (const std::string& name : one.gone) fs::remove_all(run / name);
    const Written report = report_of(run, folder);
    ASSERT_EQ(report.outcome.exit_code, 0) << one.says << report.outcome.err;
    EXPECT_TRUE(holds(report.page, one.says)) << one.says;
    EXPECT_EQ(report.twin.at("missing").empty(), false);
    if (one.gone.front() == "verdict.json") {
      EXPECT_EQ(report.twin.at("verdict"), "not verified");
      EXPECT_TRUE(holds(report.page, "<p class=\"verdict none\""));
    }
  }
}

TEST(Report, OfBrokenFilesIsOneError) {
  const struct {
    std::string file, content, says;
  } cases[] = {
      {"verdict.json", "{ \"measurements\": [ {", "verdict.json: not valid JSON near line 1"},
      {"verdict.json", "[]", "verdict.json: is no such file: must hold measurements and pass"},
      {"verdict.json", "{ \"measurements\": [ { \"name\": 3 } ], \"pass\": true }",
       "not what a run writes"},
      {"alignment.json", "{}", "alignment.json: is no such file: must hold scans"},
      {"effects.json", "7", "effects.json: is no such file: must be a list"},
      {"pose_trace.json", "{ \"steps\": [ { \"step\": \"guess\" } ] }", "not what a run writes"},
      {"poses.tum", "0 0 0 0 0 0 0 1\n", "poses.tum: has 1 poses for 8 scans"},
      {"surface.ply", "ply\n", "surface.ply"}};
  for (const auto& one : cases) {
    const Folder folder;
    const fs::path run = copy_of_run(folder);
    spill(run / one.file, one.content);
    const Written report = report_of(run, folder);
    EXPECT_EQ(report.outcome.exit_code, input) << one.file << " " << one.content;
    EXPECT_TRUE(holds(report.outcome.err, "error: ")) << report.outcome.err;
    EXPECT_TRUE(holds(report.outcome.err, one.says)) << one.says << "\n" << report.outcome.err;
    const bool is_told_of_resume =
        one.file == "surface.ply" || one.file == "poses.tum" || holds(one.says, "not valid JSON");
    EXPECT_EQ(holds(report.outcome.err, "--resume goes on with it"), is_told_of_resume)
        << report.outcome.err;
    EXPECT_EQ(std::count(report.outcome.err.begin(), report.outcome.err.end(), '\n'), 1)
        << report.outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out.html"));
  }
  const Folder folder;
  EXPECT_EQ(report_of(folder.path(), folder).outcome.exit_code, input);
}

TEST(Report, RefusesThePageItsTwinsNames) {
  const Outcome outcome =
      run_scan({"report", small_run().string(), (small_run() / "x.json").string()});
  EXPECT_EQ(outcome.exit_code, usage);
}

}  // namespace
}  // namespace scan::test
