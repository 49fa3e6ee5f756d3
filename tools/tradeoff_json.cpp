// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/tradeoff_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "libscan/core/parallel.h"
#include "tools/version.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json point_json(const Study& study, const CaseResult& in, const StudyPoint& point) {
  ordered_json stages = ordered_json::object();
  for (const auto& [stage, cost] : point.stages)
    stages[stage] = {{"seconds", cost.seconds},
                     {"processor_seconds", cost.processor_seconds},
                     {"peak_mib", cost.peak_mib}};
  ordered_json errors = ordered_json::array();
  for (const double error : point.errors) errors.push_back(number(error));
  return {{"case", in.name},
          {"settings", setting_json(study, point.setting)},
          {"error_m", number(point.error)},
          {"least_error", number(point.least_error)},
          {"most_error", number(point.most_error)},
          {"count", point.runs},
          {"seconds", point.seconds},
          {"by_seed", {{"error_m", errors}, {"seconds", point.seed_seconds}}},
          {"stages", stages},
          {"on_front", point.on_front},
          {"trouble", point.trouble}};
}

bool meets_tolerance(const StudyResult& result, const CaseResult& in) {
  return in.chosen && (result.tolerance == 0 || in.points[*in.chosen].error <= result.tolerance);
}

ordered_json case_json(const StudyResult& result, const CaseResult& in) {
  ordered_json advice = {{"text", advice_text(result, in)},
                         {"meets", result.tolerance > 0 && meets_tolerance(result, in)},
                         {"runs", in.runs},
                         {"runs_of_grid", result.runs_of_grid}};
  if (in.chosen) advice["settings"] = setting_json(result.study, in.points[*in.chosen].setting);
  ordered_json sources = ordered_json::array();
  for (const ErrorSource& source : in.sources)
    sources.push_back(
        {{"source", source.name}, {"share", source.share}, {"error_m", source.error}});
  return {{"name", in.name}, {"advice", advice}, {"sources", sources}};
}

std::string unit_of(const StudyResult& result) {
  for (const CaseResult& in : result.cases)
    if (in.chosen) return in.points[*in.chosen].unit;
  return "m";
}

// As RFC 4180 has it.
std::string csv_field(const ordered_json& value) {
  if (value.is_null()) return "";
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

bool meets_tolerance(const StudyResult& result) {
  return std::all_of(result.cases.begin(), result.cases.end(),
                     [&](const CaseResult& in) { return meets_tolerance(result, in); });
}

std::string advice_text(const StudyResult& result, const CaseResult& in) {
  const std::string where = in.name.empty() ? "" : in.name + ": ";
  if (!in.chosen) {
    const std::string& trouble = in.points.front().trouble;
    return where + "Every run failed: " + trouble + (trouble.ends_with("?") ? "" : ".");
  }
  const StudyPoint& point = in.points[*in.chosen];
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.3g", point.seconds);
  std::string text = where + setting_text(result.study, point.setting) + ": " + result.study.error +
                     " " + readable_value(point.error, point.unit) + " in " + seconds + " " +
                     seconds_text(result.study);
  const std::string tolerance = readable_value(result.tolerance, point.unit);
  if (result.tolerance == 0)
    text += ", the most accurate of those tried";
  else if (meets_tolerance(result, in))
    text += ", the cheapest of those tried within " + tolerance;
  else
    text += ", the best of those tried; none is within " + tolerance;
  const auto largest =
      std::max_element(in.sources.begin(), in.sources.end(),
                       [](const auto& a, const auto& b) { return a.share < b.share; });
  if (largest != in.sources.end()) text += ". Most of its error comes from " + largest->name;
  return text + ".";
}

ordered_json tradeoff_json(const StudyResult& result) {
  ordered_json runs = ordered_json::array(), cases = ordered_json::array();
  std::string text;
  for (const CaseResult& in : result.cases) {
    for (const StudyPoint& point : in.points) runs.push_back(point_json(result.study, in, point));
    cases.push_back(case_json(result, in));
    text += (text.empty() ? "" : "\n") + advice_text(result, in);
  }
  return {{"figure", result.study.error},
          {"unit", unit_of(result)},
          {"tolerance", result.tolerance},
          {"search", result.search},
          {"machine", machine_text()},
          {"threads", thread_count()},
          {"seconds", seconds_text(result.study)},
          {"runs", runs},
          {"cases", cases},
          {"advice", {{"text", text}, {"meets", result.tolerance > 0 && meets_tolerance(result)}}}};
}

std::string tradeoff_csv(const ordered_json& tradeoff) {
  const ordered_json& runs = tradeoff.at("runs");
  std::string table = "case";
  for (const auto& [key, value] : runs.at(0).at("settings").items()) table += "," + csv_field(key);
  table += "," + tradeoff.at("figure").get<std::string>() + ",least,most,runs,seconds";
  const std::vector<std::string> stages = {"simulate", "acquire", "align", "reconstruct"};
  for (const std::string& stage : stages)
    table += "," + stage + "_s," + stage + "_processor_s," + stage + "_peak_mib";
  table += ",on_front\n";
  for (const ordered_json& run : runs) {
    table += csv_field(run.at("case"));
    for (const auto& [key, value] : run.at("settings").items()) table += "," + csv_field(value);
    for (const char* key : {"error_m", "least_error", "most_error", "count", "seconds"})
      table += "," + csv_field(run.at(key));
    for (const std::string& stage : stages) {
      const ordered_json cost = run.at("stages").value(stage, ordered_json::object());
      for (const char* key : {"seconds", "processor_seconds", "peak_mib"})
        table += "," + csv_field(cost.value(key, ordered_json()));
    }
    table += std::string(",") + (run.at("on_front").get<bool>() ? "yes" : "no") + "\n";
  }
  return table;
}

}  // namespace scan
