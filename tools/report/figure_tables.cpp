// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figure_tables.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/console.h"
#include "tools/report/html.h"
#include "tools/report/svg.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

bool is_limited(const ordered_json& measurement) {
  return measurement.contains("limit") && measurement.at("limit").is_number();
}

std::string raw_cell(const std::string& html, bool number = false) {
  return std::string(number ? "<td class=\"number\">" : "<td>") + html + "</td>";
}

// What sampling leaves open of a figure.
std::string interval_cell(const ordered_json& m, const std::string& unit) {
  const ordered_json interval = m.value("interval", ordered_json());
  if (!interval.is_array() || interval.size() != 2) return raw_cell("", true);
  return raw_cell(exact(interval[0], unit) + " to " + exact(interval[1], unit), true);
}

// On narrow screens a name may break behind its underscores.
std::string name_cell(const ordered_json& m) {
  std::string name;
  for (const char c : escaped(m.value("name", ""))) {
    name += c;
    if (c == '_') name += "<wbr>";
  }
  return "<td class=\"name\">" + name + "</td>";
}

std::string shown_relation(const std::string& relation) {
  return relation == "<=" ? "≤" : relation == ">=" ? "≥" : relation == "==" ? "=" : "";
}

std::string limit_cell(const ordered_json& m, const std::string& unit) {
  if (!is_limited(m)) return raw_cell("", true);
  return raw_cell(shown_relation(m.value("relation", "")) + " " + exact(m.at("limit"), unit), true);
}

std::string tag(bool pass) {
  return std::string("<span class=\"tag ") + (pass ? "pass\">pass" : "fail\">FAIL") + "</span>";
}

// The limit lies within what sampling leaves open: another sample may judge otherwise.
bool is_close(const ordered_json& m) {
  const ordered_json interval = m.value("interval", ordered_json());
  if (!interval.is_array() || interval.size() != 2 || !interval[0].is_number() ||
      !interval[1].is_number())
    return false;
  const double limit = m.at("limit").get<double>();
  return m.value("relation", "") != "==" && interval[0].get<double>() < limit &&
         limit < interval[1].get<double>();
}

std::string what_it_is(const ordered_json& m) {
  const ordered_json definition = m.value("definition", ordered_json());
  std::string html;
  if (definition.is_string() && !definition.get<std::string>().empty())
    html = escaped(definition.get<std::string>()) + "<br>";
  return html + "<span class=\"quiet\">" + escaped(m.value("over", "")) + " (" +
         std::to_string(m.value("count", 0ul)) + ")</span>";
}

std::string verdict_cell(const ordered_json& m) {
  if (!is_limited(m)) return "<td></td>";
  return "<td class=\"verdicts\">" + tag(m.value("pass", false)) +
         (is_close(m) ? " <span class=\"quiet\">within its sampling</span>" : "") + "</td>";
}

// Of an upper limit what is used; of a lower one what of the value it asks for.
double share_of_limit(const ordered_json& m) {
  const double unknown = std::nan("");
  if (!m.at("value").is_number()) return unknown;
  const double value = std::abs(m.at("value").get<double>()), limit = m.at("limit").get<double>();
  const std::string relation = m.value("relation", "");
  if (relation == "<=" && limit > 0) return value / limit;
  if (relation == ">=" && value > 0) return limit / value;
  return unknown;
}

std::string joined_words(const ordered_json& list) {
  std::string text;
  for (const auto& word : list)
    text += (text.empty() ? "" : "; ") + (word.is_string() ? word.get<std::string>() : word.dump());
  return text;
}

// All in one unit, the largest with four digits.
std::string coordinates(const ordered_json& position) {
  double largest_m = 0;
  for (const auto& x : position) largest_m = std::max(largest_m, std::abs(x.get<double>()));
  const bool in_mm = largest_m < 1;
  const double unit_m = in_mm ? 1e-3 : 1;
  const int digits =
      largest_m > 0 ? 3 - static_cast<int>(std::floor(std::log10(largest_m / unit_m))) : 0;
  std::string html;
  for (const auto& x : position) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", std::clamp(digits, 0, 6), x.get<double>() / unit_m);
    html += (html.empty() ? "" : ", ") + ("<data value=\"" + x.dump() + "\">") + text + "</data>";
  }
  return html + (in_mm ? " mm" : " m");
}

// The unit that a key's ending names.
std::string unit_of(const std::string& key) {
  if (key.ends_with("_m")) return "m";
  if (key.ends_with("_rad")) return "rad";
  return "1";
}

std::string seconds_text(const ordered_json& value) {
  if (!value.is_number()) return "unknown";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g s", value.get<double>());
  return text;
}

}  // namespace

std::string limit_table(const ordered_json& measurements) {
  std::string rows;
  for (const auto& m : measurements) {
    if (!is_limited(m)) continue;
    const std::string unit = m.value("unit", "");
    rows += "<tr class=\"limited\">" + name_cell(m) + verdict_cell(m) +
            exact_cell(m.at("value"), unit) + limit_cell(m, unit) +
            raw_cell(limit_bar(share_of_limit(m), m.value("pass", false))) +
            interval_cell(m, unit) +
            "</tr><tr class=\"reason\"><td colspan=\"6\"><p>Why this limit: " +
            escaped(m.value("reason", "")) + "</p></td></tr>\n";
  }
  if (rows.empty()) return "";
  return table("The limits and what was measured; the bar shows how much of a limit is used.",
               {"figure", "verdict", "#value", "#limit", "used", "#95 % interval"}, rows);
}

std::string figure_table(const std::string& caption, const ordered_json& measurements) {
  const bool predicted = std::any_of(measurements.begin(), measurements.end(),
                                     [](const auto& m) { return m.contains("predicted"); });
  std::string rows;
  for (const auto& m : measurements) {
    const std::string unit = m.value("unit", "");
    rows += "<tr>" + name_cell(m) + exact_cell(m.at("value"), unit) + interval_cell(m, unit);
    if (predicted) rows += exact_cell(m.value("predicted", ordered_json()), unit);
    rows += limit_cell(m, unit) + verdict_cell(m) + "<td>" + what_it_is(m) + "</td></tr>\n";
  }
  std::vector<std::string> headings = {"figure", "#value", "#95 % interval"};
  if (predicted) headings.push_back("#predicted");
  headings.insert(headings.end(), {"#limit", "verdict", "what it is, over what (how many)"});
  return rows.empty() ? "" : table(caption, headings, rows);
}

std::string statistics_table(const ordered_json& s) {
  const std::vector<std::pair<std::string, std::string>> names = {
      {"mean_m", "mean"},
      {"standard_deviation_m", "standard deviation"},
      {"rms_m", "rms"},
      {"least_m", "least"},
      {"p05_m", "5 %"},
      {"median_m", "median"},
      {"p95_m", "95 %"},
      {"most_m", "most"},
      {"size_p95_m", "95 % of sizes"},
      {"size_p997_m", "99.7 % of sizes"}};
  std::vector<std::string> headings;
  std::string row;
  for (const auto& [key, name] : names) {
    headings.push_back("#" + name);
    row += exact_cell(s.at(key), "m");
  }
  return table("Signed deviations of " + s.at("count").dump() + " vertices (not of area), " +
                   s.at("unknown").dump() + " more unknown; sizes are without sign.",
               headings, "<tr>" + row + "</tr>\n");
}

std::string call_out_table(const ordered_json& call_outs) {
  std::string rows;
  for (const auto& place : call_outs)
    rows += "<tr>" + cell(place.at("number").dump(), true) +
            raw_cell(signed_exact(place.at("deviation_m"), "m"), true) +
            raw_cell(coordinates(place.at("position_m")), true) +
            (place.at("support_m").is_null() ? cell("", true)
                                             : exact_cell(place.at("support_m"), "m")) +
            "</tr>\n";
  if (rows.empty()) return "";
  return table("The worst deviations, as numbered in the pictures.",
               {"#number", "#deviation", "#position x, y, z", "#distance to the nearest point"},
               rows);
}

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

std::string pose_table(const ordered_json& alignment) {
  std::string rows;
  for (const auto& scan : alignment.at("scans"))
    rows += "<tr>" + cell(scan.value("file", "")) + cell(scan.value("stop", "")) +
            exact_cell(scan.value("rms_m", ordered_json()), "m") +
            exact_cell(scan.value("inlier_fraction_of_source", ordered_json()), "1") +
            exact_cell(scan.value("agreement", ordered_json()), "1") +
            exact_cell(scan.value("sigma_rotation_rad", ordered_json()), "rad") +
            exact_cell(scan.value("sigma_translation_m", ordered_json()), "m") +
            cell(joined_words(scan.value("weak_directions", ordered_json::array()))) + "</tr>\n";
  return table("The poses as aligned; sigma is what noise, in free motions the guess, leaves open.",
               {"scan", "stop", "#rms", "#paired", "#agreeing", "#sigma, turn", "#sigma, shift",
                "motions that the data leave free"},
               rows);
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
            raw_cell(on ? "<strong>on</strong>" : escaped(effect.value("decision", ""))) +
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
         "class=\"number\">seconds</th></tr></thead><tbody>" +
         rows + "</tbody></table>\n";
}

}  // namespace scan
