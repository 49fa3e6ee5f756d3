// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/run_tables.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/left_out.h"
#include "tools/report/html.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

std::string joined_words(const ordered_json& list) {
  std::string text;
  for (const auto& word : list)
    text += (text.empty() ? "" : "; ") + (word.is_string() ? word.get<std::string>() : word.dump());
  return text;
}

// The unit that a key's ending names.
std::string unit_of(const std::string& key) {
  if (key.ends_with("_m")) return "m";
  if (key.ends_with("_rad")) return "rad";
  return "1";
}

std::string seconds_text(const ordered_json& value) {
  if (!value.is_number()) return "unknown";
  const double seconds = value.get<double>();
  const bool in_hours = seconds >= 3599.5;
  char text[32];
  std::snprintf(text, sizeof text,
                in_hours          ? "%.3g h"
                : seconds < 999.5 ? "%.3g s"
                                  : "%.0f s",
                in_hours ? seconds / 3600 : seconds);
  return text;
}

}  // namespace

std::string scan_table(const ordered_json& scans) {
  std::string rows;
  for (const auto& scan : scans) {
    std::string misses;
    for (const auto& [reason, count] : scan.at("misses").items())
      misses += (misses.empty() ? "" : ", ") + reason + ": " + count.dump();
    rows += "<tr>" + cell(scan.value("file", "")) + exact_cell(scan.at("rays"), "count") +
            exact_cell(scan.at("points"), "count") + cell(misses) + "</tr>\n";
  }
  if (rows.empty()) return "";
  return table("What each scan delivered.", {"scan", "#rays", "#points", "rays without a point"},
               rows);
}

std::string pose_table(const ordered_json& alignment, const ordered_json& pose_errors) {
  std::string rows;
  const auto true_error = [&](const ordered_json& scan) {
    for (const auto& error : pose_errors)
      if (error.at("file") == scan.value("file", ""))
        return exact_cell(error.at("rotation_rad"), "rad") +
               exact_cell(error.at("translation_m"), "m");
    return cell("") + cell("");
  };
  for (const auto& scan : alignment.at("scans"))
    rows += "<tr>" + cell(scan.value("file", "")) + cell(scan.value("stop", "")) +
            exact_cell(scan.value("rms_m", ordered_json()), "m") +
            exact_cell(scan.value("inlier_fraction_of_source", ordered_json()), "1") +
            exact_cell(scan.value("agreement", ordered_json()), "1") +
            exact_cell(scan.value("sigma_rotation_rad", ordered_json()), "rad") +
            exact_cell(scan.value("sigma_translation_m", ordered_json()), "m") +
            (pose_errors.empty() ? "" : true_error(scan)) +
            cell(joined_words(scan.value("weak_directions", ordered_json::array()))) + "</tr>\n";
  std::vector<std::string> headings = {"scan",      "stop",         "#rms",         "#paired",
                                       "#agreeing", "#sigma, turn", "#sigma, shift"};
  std::string caption =
      "The poses as aligned. Rms is over pairs of points; paired is the share of a scan's points "
      "that have a partner, agreeing the share of those near other scans that lie on them within "
      "noise; sigma is what "
      "noise, in free motions the guess, leaves open";
  if (!pose_errors.empty()) {
    headings.insert(headings.end(), {"#off, turn", "#off, shift"});
    caption += "; off is how far a pose is from the true one, the world frame fitted to all";
  }
  headings.push_back("motions that the data leave free");
  return table(caption + ".", headings, rows);
}

std::string pair_table(const ordered_json& alignment) {
  std::string rows;
  for (const auto& pair : alignment.value("pairs", ordered_json::array()))
    rows += "<tr>" + cell(pair.value("source", "")) + cell(pair.value("target", "")) +
            cell(pair.value("accepted", false) ? "accepted" : "rejected") +
            cell(pair.value("stop", "")) + exact_cell(pair.value("overlap", ordered_json()), "1") +
            exact_cell(pair.value("agreement", ordered_json()), "1") +
            exact_cell(pair.value("rms_m", ordered_json()), "m") + "</tr>\n";
  if (rows.empty()) return "";
  return "<details><summary>Pairs of scans</summary>" +
         table("Pairs that were aligned by themselves first.",
               {"source", "target", "use", "stop", "#overlap", "#agreeing", "#rms"}, rows) +
         "</details>\n";
}

std::string effect_table(const ordered_json& effects) {
  std::string rows;
  for (const auto& effect : effects) {
    const bool on = effect.value("decision", "") == "on";
    rows += "<tr>" + cell(effect.value("effect", "")) +
            raw_cell(on                    ? "<strong>on</strong>"
                     : is_left_out(effect) ? warning_tag("left out")
                                           : escaped(effect.value("decision", ""))) +
            exact_cell(effect.value("bound_m", ordered_json()), "m") +
            exact_cell(effect.value("bound_sigma", ordered_json()), "1") +
            cell(effect.value("reason", "")) + "</tr>\n";
  }
  if (rows.empty()) return "";
  return table("What was simulated and what was left out, with a bound of the error if left out.",
               {"effect", "decision", "#bound", "#in sigmas", "reason"}, rows);
}

std::string property_list(const ordered_json& object) {
  std::string html = "<dl>";
  for (const auto& [key, value] : object.items()) {
    if (value.is_structured()) continue;
    html += "<dt>" + escaped(key) + "</dt><dd>" +
            (value.is_number()   ? exact(value, value.is_number_integer() ? "count" : unit_of(key))
               : value.is_string() ? escaped(value.get<std::string>())
             : value.is_null()   ? "none"
                                 : value.dump()) +
            "</dd>";
  }
  return html + "</dl>\n";
}

std::string cost_table(const ordered_json& cost, const ordered_json& effects) {
  std::set<std::string> on;
  for (const auto& effect : effects)
    if (effect.value("decision", "") == "on") on.insert(effect.value("effect", ""));
  std::string rows;
  const auto row = [&](const std::string& name, const std::string& text) {
    rows += "<tr>" + cell(name) + cell(text, true) + "</tr>";
  };
  if (cost.at("machine").is_string()) row("machine", cost.at("machine").get<std::string>());
  if (cost.at("threads").is_number()) row("threads", cost.at("threads").dump());
  for (const auto& [stage, value] : cost.at("seconds").items()) row(stage, seconds_text(value));
  if (cost.at("effect_seconds").is_object())
    for (const auto& [effect, value] : cost.at("effect_seconds").items())
      if (value.is_number() && value.get<double>() > 0)
        row("effect " + effect + (on.contains(effect) ? ", estimated" : ", had it been on"),
            seconds_text(value));
  return "\n<table id=\"seconds\"><thead><tr><th scope=\"col\">what</th><th scope=\"col\" "
         "class=\"number\">how long</th></tr></thead><tbody>" +
         rows + "</tbody></table>\n";
}

}  // namespace scan
