// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/units.h"
#include "tools/console.h"
#include "tools/report/html.h"
#include "tools/report/svg.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

std::string number_of(const ordered_json& value, const std::string& unit) {
  return value.is_number() ? readable_value(value.get<double>(), unit) : "unknown";
}

// What sampling leaves open of a figure.
std::string interval_of(const ordered_json& measurement, const std::string& unit) {
  if (!measurement.contains("interval") || !measurement.at("interval").is_array()) return "";
  const auto& ends = measurement.at("interval");
  return number_of(ends.at(0), unit) + " to " + number_of(ends.at(1), unit);
}

std::string banner(const ordered_json& verdict) {
  if (verdict.is_null()) return "<p class=\"verdict none\">not verified</p>";
  const bool pass = verdict.value("pass", false);
  return std::string("<p class=\"verdict ") + (pass ? "pass\">PASS" : "fail\">FAIL") + "</p>";
}

std::string measurement_table(const ordered_json& verdict) {
  std::string html =
      "<h2>Measurements</h2><table><tr><th>figure</th><th class=\"number\">value</th>"
      "<th class=\"number\">95 % interval</th><th class=\"number\">limit</th><th>verdict</th>"
      "<th>over</th></tr>";
  for (const auto& m : verdict.at("measurements")) {
    const std::string unit = m.value("unit", "");
    const bool limited = m.contains("limit") && m.at("limit").is_number();
    html +=
        "<tr>" + cell(m.value("name", "")) + cell(number_of(m.at("value"), unit), true) +
        cell(interval_of(m, unit), true) +
        cell(limited ? m.value("relation", "") + " " + number_of(m.at("limit"), unit) : "", true) +
        cell(limited ? (m.value("pass", false) ? "pass" : "FAIL") : "") +
        cell(m.value("over", "") + " (" + std::to_string(m.value("count", 0ul)) + ")") + "</tr>";
    if (limited)
      html += "<tr class=\"reason\"><td colspan=\"6\">Why this limit: " +
              escaped(m.value("reason", "")) + "</td></tr>";
  }
  return html + "</table>";
}

std::string deviation_section(const Report& report) {
  const double limit_m = deviation_limit_m(report.deviations_m);
  std::string html =
      "<h2>Deviation from the truth</h2><p>Signed distance of each surface vertex: blue lies "
      "inside "
      "the true surface, red outside. The scale holds 99 % of the vertices.</p>" +
      deviation_legend(limit_m) + "<div class=\"views\">";
  for (const View& view : six_views(report.surface, report.deviations_m, limit_m, 300))
    html += "<figure><img alt=\"surface seen from " + view.name +
            ", coloured by deviation\" src=\"data:image/png;base64," +
            base64(png_bytes(view.image)) + "\"><figcaption>" + escaped(view.name) +
            "</figcaption></figure>";
  return html + "</div>" + deviation_histogram(report.deviations_m, limit_m);
}

std::string scan_table(const Report& report) {
  std::string html =
      "<h2>Scans</h2><table><tr><th>scan</th><th class=\"number\">rays</th>"
      "<th class=\"number\">points</th><th>rays without a point</th></tr>";
  for (const auto& scan : report.simulation) {
    std::string misses;
    for (const auto& [reason, count] : scan.at("misses").items())
      misses +=
          (misses.empty() ? "" : ", ") + reason + ": " + std::to_string(count.get<std::size_t>());
    html += "<tr>" + cell(scan.value("file", "")) +
            cell(std::to_string(scan.value("rays", 0ul)), true) +
            cell(std::to_string(scan.value("points", 0ul)), true) + cell(misses) + "</tr>";
  }
  return html + "</table>";
}

std::string pose_table(const ordered_json& alignment) {
  std::string html =
      "<h2>Alignment</h2><table><tr><th>scan</th><th>stop</th><th class=\"number\">rms</th>"
      "<th class=\"number\">inliers</th><th>directions that the data leave free</th></tr>";
  for (const auto& scan : alignment.at("scans")) {
    std::string weak;
    for (const auto& direction : scan.at("weak_directions"))
      weak += (weak.empty() ? "" : "; ") + direction.get<std::string>();
    html += "<tr>" + cell(scan.value("file", "")) + cell(scan.value("stop", "")) +
            cell(number_of(scan.at("rms_m"), "m"), true) +
            cell(number_of(scan.at("inlier_fraction_of_source"), "1"), true) + cell(weak) + "</tr>";
  }
  return html + "</table>";
}

std::string effect_table(const ordered_json& effects) {
  std::string html =
      "<h2>Simulated effects</h2><table><tr><th>effect</th><th>decision</th>"
      "<th class=\"number\">error if left out</th><th>reason</th></tr>";
  for (const auto& effect : effects)
    html += "<tr>" + cell(effect.value("effect", "")) + cell(effect.value("decision", "")) +
            cell(number_of(effect.at("bound_m"), "m"), true) + cell(effect.value("reason", "")) +
            "</tr>";
  return html + "</table>";
}

std::string seconds_table(const ordered_json& seconds) {
  std::string html =
      "\n<table id=\"seconds\"><tr><th>stage</th><th class=\"number\">seconds</th></tr>";
  for (const auto& [stage, value] : seconds.items()) {
    if (!value.is_number()) continue;  // what each effect cost, see the effects
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value.get<double>());
    html += "<tr>" + cell(stage) + cell(text, true) + "</tr>";
  }
  return "<h2>What it cost</h2>" + html + "</table>\n";
}

}  // namespace

std::string report_page(const Report& report) {
  std::string html = page_head(report.title) + banner(report.verdict);
  if (!report.verdict.is_null()) html += measurement_table(report.verdict);
  if (!report.deviations_m.empty()) html += deviation_section(report);
  if (!report.simulation.is_null()) html += scan_table(report);
  if (!report.alignment.is_null()) html += pose_table(report.alignment);
  if (!report.effects.is_null()) html += effect_table(report.effects);
  if (!report.seconds.is_null()) html += seconds_table(report.seconds);
  html += "<h2>Details</h2>";
  if (!report.reconstruction.is_null()) html += details("Reconstruction", report.reconstruction);
  html += details("Recipe as run, all defaults filled in", report.recipe);
  return html + "</body></html>\n";
}

}  // namespace scan
