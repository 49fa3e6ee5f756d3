// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a report says beside its verdict, and the files that it takes from elsewhere.
#include <gtest/gtest.h>

#include "tests/tools/report_of.h"

namespace scan::test {
namespace {

constexpr int input = 3;

// Its recipe names noise alone, though the texture is finer than a pixel here and there.
TEST(Report, TellsBesideTheVerdictWhatWasLeftOut) {
  const Folder folder;
  const Written report = report_of(small_run(), folder);
  const ordered_json& left_out = report.twin.at("left_out");
  ASSERT_EQ(left_out.size(), 1u) << left_out;
  EXPECT_EQ(left_out[0].at("effect"), "footprint");
  EXPECT_EQ(left_out[0].at("by"), "recipe");
  EXPECT_GT(left_out[0].at("bound_sigma"), 1);
  const auto note =
      report.page.find("the verdict does not know what the recipe left out: footprint");
  EXPECT_LT(note, report.page.find("<nav"));
  EXPECT_TRUE(holds(report.csv, "left_out,footprint," + left_out[0].at("bound_m").dump() + ",m,"));

  const fs::path run = copy_of_run(folder);
  const Outcome text = run_scan({"verify", run.string()});
  EXPECT_EQ(text.exit_code, 0) << text.err;  // the verdict is of what was simulated
  EXPECT_TRUE(holds(text.out, "PASS\n  the verdict does not know what the recipe left out: foot"));
  const Outcome json = run_scan({"verify", run.string(), "--json"});
  EXPECT_EQ(ordered_json::parse(json.out).at("left_out"), left_out);
  EXPECT_TRUE(holds(ordered_json::parse(json.out).at("warnings").dump(), "left out: footprint"));
}

// Its sigmas are small for a texture that a pixel does not resolve: see above.
TEST(Report, SetsOffUncertaintiesThatAreNotHonest) {
  const auto verdict = ordered_json::parse(slurp(small_run() / "verdict.json"));
  std::size_t beyond = 0;
  for (const auto& m : verdict.at("measurements"))
    if (m.at("expected").is_array()) {
      EXPECT_TRUE(m.at("name").get<std::string>().starts_with("normalised_")) << m;
      beyond += m.at("value").get<double>() > m.at("expected")[1].get<double>();
    }
  ASSERT_GT(beyond, 0u);
  const std::string page = slurp(small_run() / "report.html"), words = "uncertainty stated too";
  std::size_t shown = 0;
  for (auto at = page.find(words); at != std::string::npos; at = page.find(words, at + 1)) ++shown;
  EXPECT_EQ(shown, beyond);
  const Folder folder;
  const Outcome text = run_scan({"verify", copy_of_run(folder).string()});
  EXPECT_TRUE(holds(text.out, "uncertainty stated too small (honest: ")) << text.out;
}

// Files named on the command line are not the run's.
TEST(Report, NamesTheFileThatIsNoDataSheetOrStudy) {
  const Folder folder;
  spill(folder / "list.json", "[]");
  spill(folder / "other.json", "{\"a\": 1}");
  for (const char* option : {"--artefacts", "--tradeoff"})
    for (const char* file : {"list.json", "other.json"}) {
      const Written report = report_of(small_run(), folder, {option, (folder / file).string()});
      EXPECT_EQ(report.outcome.exit_code, input) << option << report.outcome.err;
      EXPECT_TRUE(holds(report.outcome.err, std::string(file) + ": is no such file: must hold"))
          << report.outcome.err;
    }
  const Written gone = report_of(small_run(), folder, {"--artefacts", "gone.json"});
  EXPECT_EQ(gone.outcome.err, "error: gone.json: no such file\n");
}

TEST(Report, TakesADataSheetAndAStudy) {
  const Folder folder;
  spill(folder / "sheet.json",
        R"({ "pass": true, "measurements": [ { "name": "probing_form", "value": 1.25e-5,
             "unit": "m", "over": "10 balls", "count": 10, "limit": null, "pass": true,
             "predicted": [1.5e-5, 2.5e-5] } ] })");
  spill(folder / "study.json",
        R"({ "figure": "accuracy_rms", "unit": "m", "tolerance": 0.001, "machine": "a machine",
             "threads": 2, "seconds": "all",
             "cases": [ { "name": "", "sources": [],
                          "advice": { "text": "Take this.", "meets": true } } ],
             "runs": [ { "case": "", "settings": { "reconstruct/depth": 5 }, "error_m": 0.0005,
               "least_error": 0.0004, "most_error": 0.0006, "count": 2, "seconds": 1.5,
               "stages": { "align": { "seconds": 1.5, "peak_mib": 100 } }, "trouble": "",
               "on_front": true } ] })");
  const Written report = report_of(small_run(), folder,
                                   {"--artefacts", (folder / "sheet.json").string(), "--tradeoff",
                                    (folder / "study.json").string()});
  ASSERT_EQ(report.outcome.exit_code, 0) << report.outcome.err;
  EXPECT_TRUE(holds(report.page, "<data value=\"1.25e-05\">12.5 µm</data>"));
  EXPECT_TRUE(holds(
      report.page, "<data value=\"1.5e-05\">15 µm</data> to <data value=\"2.5e-05\">25 µm</data>"));
  EXPECT_TRUE(holds(report.page, "smaller than predicted"));
  EXPECT_TRUE(holds(report.csv, "artefacts,probing_form,1.25e-05,m"));
  EXPECT_TRUE(holds(report.csv, "10 balls,1.5e-05,2.5e-05\n"));
  EXPECT_TRUE(holds(report.page, "Take this."));
  EXPECT_FALSE(holds(report.page, "data sheet</a> fails"));
  EXPECT_TRUE(holds(report.page, "<th class=\"number\">seconds</th>"));
  EXPECT_TRUE(holds(report.page, "<section id=\"tradeoff\""));
}

}  // namespace
}  // namespace scan::test
