// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A scanner's data sheet judged by its recipe's limits, as a user meets it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/small_run.h"

namespace scan::test {
namespace {

constexpr int failed = 1, input = 3;

using nlohmann::ordered_json;

// A camera so coarse that a form of 1 um and one beyond the measuring volume are no question.
std::string recipe(const std::string& limits) {
  return R"({"libscan": 1, "name": "bench", "seed": 5,
    "scene": {"objects": [{"material": "clay", "shape": {"sphere": {"radius_mm": 150}}}],
      "materials": {"clay": {"diffuse": 0.8}}},
    "scanner": {"phase_camera": {"camera": {"width_px": 160, "height_px": 120, "focal_px": 180},
      "frequencies_mhz": [60, 100], "electrons_at_1m": 60000, "contrast": 0.6,
      "sensor": {"gain_e_per_dn": 2, "read_noise_e": 20, "full_well_e": 120000, "bits": 16},
      "max_range_m": 7}},
    "viewpoints": {"dome": {"count": 1, "radius_mm": 900}}, "effects": ["shot-noise"],
    "artefacts": {"volume_mm": [400, 300, 300]})" +
         limits + "}";
}

struct Sheet {
  Outcome outcome;
  ordered_json json;
  const ordered_json& row(const std::string& name) const {
    for (const auto& m : json.at("measurements"))
      if (m.at("name") == name) return m;
    throw std::runtime_error(name + " is not in the sheet");
  }
};

Sheet sheet_of(const Folder& folder, const std::string& limits) {
  spill(folder / "bench.json", recipe(limits));
  Sheet sheet{run_scan({"verify", "--artefacts", (folder / "bench.json").string(), "--json"}), {}};
  if (sheet.outcome.exit_code <= failed) sheet.json = ordered_json::parse(sheet.outcome.out);
  return sheet;
}

// Its signed errors are small and below 0 or above: "within" holds them both ways, and at_most
// alone would pass whatever is below.
TEST(ArtefactSheet, IsJudgedRowByRow) {
  const Folder folder;
  const Sheet sheet = sheet_of(folder, R"(, "artefact_limits": [
    {"name": "probing_form", "at_most_mm": 500, "reason": "The volume."},
    {"name": "flatness", "at_most_um": 1, "reason": "No camera."},
    {"name": "probing_size", "within_mm": 500, "reason": "The volume."},
    {"name": "step_error", "within_nm": 1, "reason": "No camera."},
    {"name": "cylinder_axis_error", "at_most_deg": 20, "reason": "An upright post."}])");
  ASSERT_EQ(sheet.outcome.exit_code, failed) << sheet.outcome.err;
  EXPECT_FALSE(sheet.json.at("pass"));
  EXPECT_TRUE(sheet.row("probing_form").at("pass"));
  EXPECT_EQ(sheet.row("probing_form").at("limit"), 0.5);
  EXPECT_FALSE(sheet.row("flatness").at("pass"));
  EXPECT_TRUE(sheet.row("probing_size").at("pass"));
  EXPECT_FALSE(sheet.row("step_error").at("pass"));
  EXPECT_EQ(sheet.row("step_error").at("relation"), "within");
  EXPECT_TRUE(sheet.row("cylinder_axis_error").at("pass"));
  EXPECT_TRUE(sheet.row("cylindricity").at("limit").is_null());

  spill(folder / "sheet.json", sheet.outcome.out);
  const Outcome report = run_scan({"report", small_run().string(), (folder / "r.html").string(),
                                   "--artefacts", (folder / "sheet.json").string()});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  const std::string csv = slurp(folder / "r.csv"), page = slurp(folder / "r.html");
  const auto line = [&](const std::string& name) {
    const auto at = csv.find("artefacts," + name + ",");
    return csv.substr(at, csv.find('\n', at) - at);
  };
  EXPECT_NE(line("probing_form").find(",<=,0.5,true,"), std::string::npos) << line("probing_form");
  EXPECT_NE(line("flatness").find(",<=,1e-06,false,"), std::string::npos) << line("flatness");
  EXPECT_NE(line("cylindricity").find(",,,,,,"), std::string::npos) << line("cylindricity");
  const std::string part = page.substr(page.find("<section id=\"artefacts\""));
  EXPECT_NE(part.find("within <data value=\"0.5\">500 mm</data>"), std::string::npos);
  EXPECT_NE(part.find("FAIL</span>"), std::string::npos);
  EXPECT_NE(part.find("Why this limit: An upright post."), std::string::npos);
  EXPECT_EQ(part.find("95 % interval"), std::string::npos) << "nothing here is sampled";
  EXPECT_NE(page.find("data sheet</a> fails:</strong> 3 of 5 limits are met."), std::string::npos);
}

TEST(ArtefactSheet, WithoutLimitsHasNoColumnsOfThem) {
  const Folder folder;
  const Sheet sheet = sheet_of(folder, "");
  ASSERT_EQ(sheet.outcome.exit_code, 0) << sheet.outcome.err;
  // This camera's noise is what its sigma says, and a prediction holds 95 % of what chance does: of
  // 20 figures four or more beyond come once in 60 sheets. Signed figures lie to both sides of 0.
  std::size_t beyond = 0;
  for (const auto& m : sheet.json.at("measurements")) {
    const double low = m.at("predicted")[0], high = m.at("predicted")[1], is = m.at("value");
    beyond += low < 0 && high > 0 ? std::abs(is) > std::max(-low, high) : is < low || high < is;
    EXPECT_LE(low, high) << m.dump();
  }
  EXPECT_LE(beyond, 3u);
  EXPECT_LT(sheet.row("relative_range_error").at("predicted")[0], 0);
  EXPECT_GT(sheet.row("relative_range_error").at("predicted")[1], 0);
  spill(folder / "sheet.json", sheet.outcome.out);
  const Outcome report = run_scan({"report", small_run().string(), (folder / "r.html").string(),
                                   "--artefacts", (folder / "sheet.json").string()});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  const std::string page = slurp(folder / "r.html");
  const auto at = page.find("<section id=\"artefacts\"");
  const std::string part = page.substr(at, page.find("</section>", at) - at);
  EXPECT_NE(part.find("predicted</th>"), std::string::npos);
  EXPECT_EQ(part.find("limit</th>"), std::string::npos);
  EXPECT_EQ(part.find("verdict</th>"), std::string::npos);
}

TEST(ArtefactSheet, KeepsItsLimitsInTheRunsRecipe) {
  const Folder folder;
  spill(folder / "bench.json", recipe(R"(, "artefact_limits": [
    {"name": "step_error", "within_um": 50, "reason": "The groove."}], "limits": [
    {"name": "range_error_bias", "within_mm": 2, "reason": "The map."}])"));
  const Outcome outcome =
      run_scan({"simulate", (folder / "bench.json").string(), (folder / "run").string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto written = ordered_json::parse(slurp(folder / "run/recipe.json"));
  EXPECT_DOUBLE_EQ(written.at("artefact_limits")[0].at("within_m"), 5e-5);
  EXPECT_DOUBLE_EQ(written.at("limits")[0].at("within_m"), 2e-3);
}

TEST(ArtefactSheet, LimitsThatNothingCanKeepAreRefused) {
  const Folder folder;
  const Sheet sheet = sheet_of(folder, R"(, "artefact_limits": [
    {"name": "step_error", "within_mm": -1, "reason": "A slip."}])");
  EXPECT_EQ(sheet.outcome.exit_code, input) << sheet.outcome.err;
  EXPECT_NE(sheet.outcome.err.find("within less than 0"), std::string::npos) << sheet.outcome.err;
}

}  // namespace
}  // namespace scan::test
