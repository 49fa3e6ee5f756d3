// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figure_tables.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/report/html.h"
#include "tools/report/svg.h"
#include "tools/verdict_text.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

bool is_limited(const ordered_json& measurement) {
  return measurement.contains("limit") && measurement.at("limit").is_number();
}

bool has_range(const ordered_json& m, const char* key) {
  const ordered_json range = m.value(key, ordered_json());
  return range.is_array() && range.size() == 2;
}

bool has_interval(const ordered_json& m) {
  return has_range(m, "interval");
}

std::string range_cell(const ordered_json& m, const char* key, const std::string& unit) {
  if (!has_range(m, key)) return raw_cell("", true);
  const ordered_json& range = m.at(key);
  return raw_cell(exact(range[0], unit) + " to " + exact(range[1], unit), true);
}

// What sampling leaves open of a figure.
std::string interval_cell(const ordered_json& m, const std::string& unit) {
  return range_cell(m, "interval", unit);
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
  if (relation == "within") return relation;
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
  if (!has_interval(m)) return false;
  const ordered_json& interval = m.at("interval");
  if (!interval[0].is_number() || !interval[1].is_number()) return false;
  const double limit = m.at("limit").get<double>();
  return m.value("relation", "") != "==" && interval[0].get<double>() < limit &&
         limit < interval[1].get<double>();
}

std::string what_it_is(const ordered_json& m) {
  const ordered_json definition = m.value("definition", ordered_json());
  std::string html;
  if (const std::string remark = statement_remark(m); !remark.empty())
    html = warning_tag(remark) + " <span class=\"quiet\">honest: " + exact(m["expected"][0], "1") +
           " to " + exact(m["expected"][1], "1") + "</span><br>";
  if (const std::string remark = prediction_remark(m); !remark.empty())
    html += warning_tag(remark) + "<br>";
  if (definition.is_string() && !definition.get<std::string>().empty())
    html += escaped(definition.get<std::string>()) + "<br>";
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
  if ((relation == "<=" || relation == "within") && limit > 0) return value / limit;
  if (relation == ">=" && value > 0) return limit / value;
  return unknown;
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

}  // namespace

std::string limit_table(const ordered_json& measurements) {
  const bool sampled = std::any_of(measurements.begin(), measurements.end(),
                                   [](const auto& m) { return is_limited(m) && has_interval(m); });
  std::string rows;
  for (const auto& m : measurements) {
    if (!is_limited(m)) continue;
    const std::string unit = m.value("unit", "");
    rows += "<tr class=\"limited\">" + name_cell(m) + verdict_cell(m) +
            exact_cell(m.at("value"), unit) + limit_cell(m, unit) +
            raw_cell(limit_bar(share_of_limit(m), m.value("pass", false))) +
            (sampled ? interval_cell(m, unit) : "") + "</tr><tr class=\"reason\"><td colspan=\"" +
            (sampled ? "6" : "5") + "\"><p>Why this limit: " + escaped(m.value("reason", "")) +
            "</p></td></tr>\n";
  }
  if (rows.empty()) return "";
  std::vector<std::string> headings = {"figure", "verdict", "#value", "#limit", "used"};
  if (sampled) headings.push_back("#95 % interval");
  return table("The limits and what was measured; the bar shows how much of a limit is used.",
               headings, rows);
}

std::string figure_table(const std::string& caption, const ordered_json& measurements) {
  const auto any = [&](const auto& has) {
    return std::any_of(measurements.begin(), measurements.end(), has);
  };
  const bool sampled = any(has_interval), limited = any(is_limited),
             predicted = any([](const auto&m) { return m.contains("predicted"); });
  std::string rows;
  for (const auto& m : measurements) {
    const std::string unit = m.value("unit", "");
    rows += "<tr>" + name_cell(m) + exact_cell(m.at("value"), unit);
    if (sampled) rows += interval_cell(m, unit);
    if (predicted) rows += range_cell(m, "predicted", unit);
    if (limited) rows += limit_cell(m, unit) + verdict_cell(m);
    rows += "<td>" + what_it_is(m) + "</td></tr>\n";
  }
  std::vector<std::string> headings = {"figure", "#value"};
  if (sampled) headings.push_back("#95 % interval");
  if (predicted) headings.push_back("#predicted");
  if (limited) headings.insert(headings.end(), {"#limit", "verdict"});
  headings.push_back("what it is, over what (how many)");
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

}  // namespace scan
