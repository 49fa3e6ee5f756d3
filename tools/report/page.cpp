// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/left_out.h"
#include "tools/report/deviation_map.h"
#include "tools/report/figure_tables.h"
#include "tools/report/html.h"
#include "tools/report/run_tables.h"
#include "tools/report/scene_data.h"
#include "tools/report/svg.h"
#include "tools/report/tradeoff_page.h"
#include "tools/report/viewer.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

struct Part {
  std::string id, title, content;
};

struct Limits {
  std::size_t set = 0, met = 0;
};
Limits limits_of(const ordered_json& measurements) {
  Limits limits;
  for (const auto& m : measurements) {
    if (!m.contains("limit") || !m.at("limit").is_number()) continue;
    ++limits.set;
    limits.met += m.value("pass", false);
  }
  return limits;
}

std::string met_text(const Limits& limits) {
  return std::to_string(limits.met) + " of " + std::to_string(limits.set) + " limits are met.";
}

// "4 of 5 limits are met", or why nothing was judged.
std::string verdict_sentence(const ordered_json& twin) {
  const Limits limits = limits_of(twin.at("measurements"));
  if (twin.at("verdict") == "not verified") return "The run was not verified.";
  if (limits.set == 0) return "The recipe sets no limit: figures without a judgement.";
  return met_text(limits);
}

// The verdict is the run's; its scanner's data sheet may have one of its own.
std::string sheet_note(const ordered_json& sheet) {
  if (!sheet.is_object()) return "";
  const Limits limits = limits_of(sheet.at("measurements"));
  if (limits.met == limits.set) return "";
  return "<div class=\"note\" role=\"note\"><strong>The scanner's <a href=\"#artefacts\">data "
         "sheet</a> fails:</strong> " +
         met_text(limits) + "</div>\n";
}

// "laser line, 20 scans, 206320 points; surface of 199182 triangles by ssd"
std::string what_was_done(const ordered_json& twin) {
  std::string text;
  const ordered_json& recipe = twin.at("recipe");
  if (recipe.contains("scanner") && recipe.at("scanner").is_object() &&
      !recipe.at("scanner").empty())
    text = recipe.at("scanner").begin().key();
  std::replace(text.begin(), text.end(), '_', ' ');
  std::size_t points = 0;
  for (const auto& scan : twin.at("scans")) points += scan.at("points").get<std::size_t>();
  text += (text.empty() ? "" : ", ") + std::to_string(twin.at("scans").size()) + " scans, " +
          std::to_string(points) + " points";
  const ordered_json& surface = twin.at("reconstruction");
  if (surface.is_object() && surface.contains("triangles"))
    text += "; surface of " + surface.at("triangles").dump() + " triangles by " +
            surface.value("method", "an unknown method");
  return text;
}

std::string header(const ordered_json& twin) {
  const std::string word = twin.at("verdict").get<std::string>();
  const std::string kind = word == "not verified" ? "none" : word;
  std::string shown = word;
  if (kind != "none")
    std::transform(shown.begin(), shown.end(), shown.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const ordered_json& made = twin.at("provenance");
  return "<a class=\"skip\" href=\"#verdict\">Skip to the verdict</a>\n<header>"
         "<p class=\"verdict " +
         kind + "\" role=\"status\">" + shown + "</p><h1>" +
         escaped(twin.at("title").get<std::string>()) + "</h1><p>" + verdict_sentence(twin) +
         " <span class=\"quiet\">" + escaped(what_was_done(twin)) + ". Seed " +
         made.at("seed").dump() + ", libscan " + escaped(made.at("version").get<std::string>()) +
         "</span></p></header>\n";
}

std::string contents(const std::vector<Part>& parts) {
  std::string html = "<nav aria-label=\"Contents\"><ol>";
  for (const Part& part : parts)
    html += "<li><a href=\"#" + part.id + "\">" + escaped(part.title) + "</a></li>";
  return html + "</ol></nav>\n";
}

std::string missing_note(const ordered_json& missing) {
  if (missing.empty()) return "";
  std::string html =
      "<div class=\"note\" role=\"note\"><strong>This run is not whole.</strong><ul>";
  for (const auto& sentence : missing)
    html += "<li>" + escaped(sentence.get<std::string>()) + "</li>";
  return html + "</ul></div>\n";
}

// Beside the verdict: what it does not cover.
std::string left_out_note(const ordered_json& left_out) {
  const std::string text = left_out_text(left_out);
  if (text.empty()) return "";
  return "<div class=\"note\" role=\"note\"><strong>Not the whole physics:</strong> " +
         escaped(text) + ".</div>\n";
}

std::string verdict_part(const ordered_json& twin) {
  const std::string limits = limit_table(twin.at("measurements"));
  if (limits.empty()) return "<p>" + verdict_sentence(twin) + "</p>";
  return "<p class=\"quiet\">A figure passes where its value keeps the limit. The interval holds "
         "the figure of the whole surface with 95 % confidence; where the limit lies in it, "
         "another sample of the surface may be judged otherwise.</p>" +
         limits;
}

std::string histogram_part(const ordered_json& twin) {
  const ordered_json& deviation = twin.at("deviation");
  if (deviation.is_null()) return "";
  const ordered_json& h = deviation.at("histogram");
  std::vector<HistogramLimit> limits;
  for (const auto& m : twin.at("measurements"))
    if (m.value("name", "").starts_with("accuracy_") && m.at("limit").is_number())
      limits.push_back({"limit of " + m.value("name", ""), m.at("limit").get<double>()});
  return histogram_plot({.limit_m = h.at("limit_m").get<double>(),
                         .counts = h.at("counts").get<std::vector<std::size_t>>(),
                         .below = h.at("below").get<std::size_t>(),
                         .above = h.at("above").get<std::size_t>()},
                        limits) +
         statistics_table(deviation.at("statistics"));
}

std::string provenance_part(const ordered_json& twin) {
  const ordered_json& made = twin.at("provenance");
  ordered_json plain = made;
  for (const auto& [library, version] : made.at("libraries").items()) plain[library] = version;
  plain["recipe"] = "fingerprint " + made.at("recipe").get<std::string>();
  std::string html = property_list(plain);
  if (!twin.at("reconstruction").is_null())
    html += "<h3>Reconstruction</h3>" + property_list(twin.at("reconstruction"));
  return html + details("The recipe as run, all defaults filled in", twin.at("recipe"));
}

// The parts that are drawn rather than listed.
struct Drawn {
  std::string map, view;
};

std::vector<Part> parts_of(const ordered_json& twin, const Drawn& drawn) {
  std::vector<Part> parts = {{"verdict", "Verdict", verdict_part(twin)},
                             {"map", "Deviation map", drawn.map},
                             {"view", "3D view", drawn.view},
                             {"histogram", "Histogram", histogram_part(twin)},
                             {"figures", "All figures",
                              figure_table("Every figure of the verdict, with what it was "
                                           "taken over.",
                                           twin.at("measurements"))}};
  if (!twin.at("alignment").is_null())
    parts.push_back({"poses", "Poses",
                     pose_table(twin.at("alignment"), twin.at("pose_errors")) +
                         pair_table(twin.at("alignment"))});
  parts.push_back({"scans", "Scans", scan_table(twin.at("scans"))});
  if (twin.at("effects").is_array())
    parts.push_back({"effects", "Simulated effects", effect_table(twin.at("effects"))});
  if (twin.at("artefacts").is_object())
    parts.push_back({"artefacts", "Scanner's data sheet",
                     limit_table(twin.at("artefacts").at("measurements")) +
                         figure_table("Errors on calibrated bodies, after VDI/VDE 2634 and ISO "
                                      "10360-13, not certified; predicted is where 95 % of the "
                                      "figures lie that the points' own sigma and spacing allow.",
                                      twin.at("artefacts").at("measurements"))});
  if (twin.at("tradeoff").is_object())
    parts.push_back({"tradeoff", "Accuracy against time", tradeoff_parts(twin.at("tradeoff"))});
  parts.push_back({"cost", "What it cost", cost_table(twin.at("cost"), twin.at("effects"))});
  parts.push_back({"provenance", "Provenance", provenance_part(twin)});
  if (!drawn.view.empty())
    parts.push_back({"licences", "Licences",
                     "<details><summary>three.js, which draws the 3D "
                     "view</summary><pre>" +
                         escaped(std::string(asset("three-licence.txt"))) + "</pre></details>\n"});
  std::erase_if(parts, [](const Part& part) { return part.content.empty(); });
  return parts;
}

std::string page_with(const ordered_json& twin, const Drawn& drawn) {
  const std::vector<Part> parts = parts_of(twin, drawn);
  std::string html =
      page_head(twin.at("title").get<std::string>() + " - libscan report",
                drawn.view.empty() ? std::vector<std::string_view>{} : viewer_scripts());
  html += header(twin) + left_out_note(twin.at("left_out")) + sheet_note(twin.at("artefacts")) +
          contents(parts) + missing_note(twin.at("missing")) + "<main>\n";
  for (const Part& part : parts) html += section(part.id, part.title, part.content);
  return html + "</main></body></html>\n";
}

}  // namespace

std::string report_page(const RunRecord& record, const ordered_json& twin) {
  Drawn drawn{deviation_map(record, twin), ""};
  if (record.surface.empty() && record.world_from_scan.empty()) return page_with(twin, drawn);
  for (std::size_t points = most_page_points; points > 1000; points -= points / 4) {
    drawn.view = viewer(record, twin, points);
    std::string page = page_with(twin, drawn);
    if (page.size() < most_page_bytes) return page;
  }
  drawn.view.clear();
  return page_with(twin, drawn);
}

}  // namespace scan
