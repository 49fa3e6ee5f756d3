// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The pictures that stand in datasets/studies are what the program draws of the tables beside them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "libscan/core/error.h"
#include "tools/report/embedded.h"
#include "tools/report/tradeoff_page.h"
#include "tools/study_search.h"

namespace scan {

// A picture alone carries none, and does not tell the version.
const std::vector<EmbeddedFile>& report_assets() {
  static const std::vector<EmbeddedFile> none;
  return none;
}

std::string version_text() {
  return "";
}

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

// None of these tables quotes a field.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

std::vector<std::map<std::string, std::string>> rows_of(const fs::path& csv) {
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> heads = fields_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = fields_of(line);
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < fields.size(); ++i) row[heads[i]] = fields[i];
  }
  return rows;
}

ordered_json run_json(const Study& study, const std::map<std::string, std::string>& row) {
  ordered_json settings = ordered_json::object();
  for (const Variation& variation : study.vary)
    for (const Choice& choice : variation.choices) {
      const std::string shown =
          choice.label.is_string() ? choice.label.get<std::string>() : choice.label.dump();
      if (shown == row.at(variation.name)) settings[variation.name] = choice.label;
    }
  return {{"case", row.at("case")},
          {"settings", settings},
          {"error_m", std::stod(row.at(study.error))},
          {"least_error", std::stod(row.at("least"))},
          {"most_error", std::stod(row.at("most"))},
          {"seconds", std::stod(row.at("seconds"))},
          {"on_front", row.at("on_front") == "yes"}};
}

// As tradeoff_json() gives it, as far as the picture needs it. Without a tolerance the advice is
// the most accurate.
ordered_json tradeoff_of(const Study& study, const fs::path& csv) {
  ordered_json runs = ordered_json::array(), cases = ordered_json::array();
  for (const auto& row : rows_of(csv)) runs.push_back(run_json(study, row));
  for (const Case& in : study.cases) {
    const ordered_json* best = nullptr;
    for (const ordered_json& run : runs)
      if (run["case"] == in.name && (!best || run["error_m"] < (*best)["error_m"])) best = &run;
    cases.push_back({{"name", in.name}, {"advice", {{"settings", best->at("settings")}}}});
  }
  return {{"figure", study.error},          {"unit", "m"},  {"tolerance", 0},
          {"seconds", seconds_text(study)}, {"runs", runs}, {"cases", cases}};
}

class StudyPicture : public testing::TestWithParam<const char*> {};

TEST_P(StudyPicture, IsWhatItsTableDraws) {
  const fs::path folder = fs::path(LIBSCAN_SOURCE_DIR "/datasets/studies") / GetParam();
  const nlohmann::json recipe = nlohmann::json::parse(std::ifstream(folder / "study.json"));
  const Study study = read_study(JsonReader(recipe.at("tradeoff"), GetParam()));
  const std::string drawn = tradeoff_picture(tradeoff_of(study, folder / "results.csv"));
  std::ostringstream shipped;
  shipped << std::ifstream(folder / "curve.svg").rdbuf();
  if (drawn == shipped.str()) return;
  const fs::path written = fs::path(testing::TempDir()) / (std::string(GetParam()) + ".svg");
  std::ofstream(written) << drawn;
  ADD_FAILURE() << folder / "curve.svg"
                << " is not drawn from its table; that gives " << written;
}

INSTANTIATE_TEST_SUITE_P(Studies, StudyPicture,
                         testing::Values("effects", "alignment_methods", "surface_methods",
                                         "scanners"));

}  // namespace
}  // namespace scan
