// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/twin.h"

#include <cmath>

#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "tools/left_out.h"
#include "tools/report/deviation.h"
#include "tools/report/picture.h"
#include "tools/run_files.h"
#include "tools/version.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t bins = 72;
constexpr std::size_t call_outs = 8;
constexpr double apart_share = 0.06;  // of the surface's diagonal, between two call-outs

ordered_json statistics_json(const DeviationStatistics& s) {
  return {{"count", s.count},           {"unknown", s.unknown},
          {"mean_m", s.mean_m},         {"standard_deviation_m", s.standard_deviation_m},
          {"rms_m", s.rms_m},           {"least_m", s.least_m},
          {"p05_m", s.p05_m},           {"median_m", s.median_m},
          {"p95_m", s.p95_m},           {"most_m", s.most_m},
          {"size_p95_m", s.size_p95_m}, {"size_p997_m", s.size_p997_m}};
}

ordered_json deviation_json(const RunRecord& record) {
  if (record.deviations_m.empty()) return nullptr;
  const double limit_m = deviation_limit_m(record.deviations_m);
  const DeviationHistogram histogram = deviation_histogram(record.deviations_m, limit_m, bins);
  const double apart_m = apart_share * bounds_of(record.surface.vertices).diagonal().norm();
  ordered_json worst = ordered_json::array();
  for (const std::uint32_t i :
       worst_places(record.surface, record.deviations_m, call_outs, apart_m)) {
    const Eigen::Vector3d& at = record.surface.vertices[i];
    worst.push_back({{"number", worst.size() + 1},
                     {"position_m", {at.x(), at.y(), at.z()}},
                     {"deviation_m", record.deviations_m[i]},
                     {"support_m", record.support_m.empty() ? ordered_json()
                                                            : ordered_json(record.support_m[i])}});
  }
  return {{"statistics", statistics_json(deviation_statistics(record.deviations_m))},
          {"histogram",
           {{"limit_m", histogram.limit_m},
            {"counts", histogram.counts},
            {"below", histogram.below},
            {"above", histogram.above}}},
          {"call_outs", worst}};
}

ordered_json pose_errors_json(const RunRecord& record) {
  ordered_json errors = ordered_json::array();
  for (std::size_t i = 0; i < record.pose_errors.size(); ++i)
    errors.push_back({{"file", "scans/" + scan_name(i) + ".ply"},
                      {"rotation_rad", record.pose_errors[i].rotation_rad},
                      {"translation_m", record.pose_errors[i].translation_m},
                      {"rms_m", record.pose_errors[i].moved_points_rms_m}});
  return errors;
}

ordered_json cost_json(const ordered_json& timings) {
  ordered_json seconds = ordered_json::object();
  for (const auto& [stage, value] : timings.items())
    if (value.is_number() && stage != "threads") seconds[stage] = value;
  const auto part = [&](const char* key) {
    return timings.is_object() && timings.contains(key) ? timings.at(key) : ordered_json();
  };
  return {{"machine", part("machine")},
          {"threads", part("threads")},
          {"seconds", seconds},
          {"effect_seconds", part("effects")}};
}

std::string verdict_word(const ordered_json& verdict) {
  if (verdict.is_null()) return "not verified";
  return verdict.at("pass").get<bool>() ? "pass" : "fail";
}

std::string csv_field(const ordered_json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_line(const std::vector<ordered_json>& fields) {
  std::string line;
  for (const ordered_json& field : fields) line += (line.empty() ? "" : ",") + csv_field(field);
  return line + "\n";
}

std::string measurement_lines(const std::string& part, const ordered_json& measurements) {
  std::string csv;
  for (const auto& m : measurements) {
    const auto key = [&](const char* name) { return m.value(name, ordered_json()); };
    const auto end = [&](const char* range, std::size_t i) {
      const ordered_json ends = key(range);
      return ends.is_array() && ends.size() == 2 ? ends[i] : ordered_json();
    };
    csv += csv_line({part, key("name"), key("value"), key("unit"), end("interval", 0),
                     end("interval", 1), key("relation"), key("limit"),
                     key("limit").is_null() ? "" : key("pass"), key("count"), key("over"),
                     end("predicted", 0), end("predicted", 1)});
  }
  return csv;
}

std::string plain_line(const std::string& part, const std::string& name, const ordered_json& value,
                       const std::string& unit) {
  const ordered_json none;
  return csv_line({part, name, value, unit, none, none, none, none, none, none, none, none, none});
}

}  // namespace

ordered_json report_twin(const RunRecord& record) {
  const ordered_json& verdict = record.verdict;
  ordered_json scans = ordered_json::array();
  for (std::size_t i = 0; i < record.scans.size(); ++i)
    scans.push_back(scan_json("scans/" + scan_name(i) + ".ply", record.scans[i]));
  return {{"report", 1},
          {"title", record.title},
          {"verdict", verdict_word(verdict)},
          {"missing", record.missing},
          {"left_out", left_out_effects(record.effects, record.recipe)},
          {"provenance",
           {{"version", version_text()},
            {"compiler", version_json().at("compiler")},
            {"libraries", version_json().at("libraries")},
            {"seed", record.recipe.value("seed", ordered_json())},
            {"recipe", fingerprint(json_text(record.recipe))}}},
          {"measurements", verdict.is_null() ? ordered_json::array() : verdict.at("measurements")},
          {"deviation", deviation_json(record)},
          {"scans", scans},
          {"alignment", record.alignment},
          {"pose_errors", pose_errors_json(record)},
          {"reconstruction", record.reconstruction},
          {"effects", record.effects},
          {"artefacts", record.artefacts},
          {"tradeoff", record.tradeoff},
          {"recipe", record.recipe},
          {"cost", cost_json(record.timings)}};
}

std::string report_csv(const ordered_json& twin) {
  std::string csv =
      "part,name,value,unit,low,high,relation,limit,pass,count,over,predicted_low,predicted_high\n";
  csv += measurement_lines("verdict", twin.at("measurements"));
  for (const auto& effect : twin.at("left_out"))
    csv += plain_line("left_out", effect.at("effect"), effect.at("bound_m"), "m");
  if (const ordered_json& deviation = twin.at("deviation"); !deviation.is_null()) {
    for (const auto& [name, value] : deviation.at("statistics").items())
      csv += plain_line("deviation", name, value, name.ends_with("_m") ? "m" : "count");
    for (const auto& place : deviation.at("call_outs"))
      csv += plain_line("call_out", place.at("number").dump(), place.at("deviation_m"), "m");
  }
  for (const auto& error : twin.at("pose_errors"))
    csv += plain_line("pose_error", error.at("file"), error.at("rms_m"), "m");
  if (const ordered_json& sheet = twin.at("artefacts"); !sheet.is_null())
    csv += measurement_lines("artefacts", sheet.at("measurements"));
  return csv;
}

}  // namespace scan
