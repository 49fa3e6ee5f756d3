// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/units.h"
#include "tools/console.h"
#include "tools/report/svg.h"
#include "tools/version.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

const char* const style = R"(
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1b1b1b; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { margin-bottom: 0; } h2 { margin-top: 2.2rem; border-bottom: 1px solid #ccc; }
.verdict { display: inline-block; padding: .3rem 1rem; border-radius: .3rem; font-weight: 700; color: #fff; }
.pass { background: #1a6b3a; } .fail { background: #a11a2b; } .none { background: #555; }
table { border-collapse: collapse; width: 100%; margin: .6rem 0; }
th, td { text-align: left; padding: .3rem .6rem; border-bottom: 1px solid #ddd; vertical-align: top; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.views { display: grid; grid-template-columns: repeat(3, 1fr); gap: .6rem; }
figure { margin: 0; } figcaption { text-align: center; font-size: .9rem; } img { width: 100%; border: 1px solid #ddd; }
pre { background: #f5f5f5; padding: 1rem; overflow-x: auto; font-size: .85rem; }
@media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } tr, figure { break-inside: avoid; } }
)";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
    };
    const unsigned word = at(0) << 16 | at(1) << 8 | at(2);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string cell(const std::string& text, bool number = false) {
  return std::string(number ? "<td class=\"number\">" : "<td>") + escaped(text) + "</td>";
}

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
      "<th class=\"number\">95 % interval</th><th "
      "class=\"number\">limit</th><th>verdict</th><th>over</th><th>reason of the "
      "limit</th></tr>";
  for (const auto& m : verdict.at("measurements")) {
    const std::string unit = m.value("unit", "");
    const bool limited = m.contains("limit") && m.at("limit").is_number();
    html +=
        "<tr>" + cell(m.value("name", "")) + cell(number_of(m.at("value"), unit), true) +
        cell(interval_of(m, unit), true) +
        cell(limited ? m.value("relation", "") + " " + number_of(m.at("limit"), unit) : "", true) +
        cell(limited ? (m.value("pass", false) ? "pass" : "FAIL") : "") +
        cell(m.value("over", "") + " (" + std::to_string(m.value("count", 0ul)) + ")") +
        cell(m.contains("reason") && m.at("reason").is_string() ? m.value("reason", "") : "") +
        "</tr>";
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

std::string details(const std::string& title, const ordered_json& json) {
  return "<details><summary>" + escaped(title) + "</summary><pre>" + escaped(json.dump(2)) +
         "</pre></details>";
}

}  // namespace

std::string report_page(const Report& report) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>" +
      escaped(report.title) + "</title><style>" + style + "</style></head><body><h1>" +
      escaped(report.title) + "</h1><p>libscan " + version_text() + "</p>" + banner(report.verdict);
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
