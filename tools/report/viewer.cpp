// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/viewer.h"

#include <array>
#include <nlohmann/json.hpp>

#include "tools/report/html.h"
#include "tools/report/picture.h"
#include "tools/report/point_pack.h"
#include "tools/report/scene_data.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

constexpr int picture_width_px = 640, picture_height_px = 400;
constexpr std::string_view library = "three.min.js";
// In the order in which they run.
constexpr std::array<std::string_view, 5> own_scripts = {"unpack.js", "orbit.js", "cloud.js",
                                                         "keys.js", "viewer.js"};

std::string picture(const RunRecord& record, const ordered_json& twin) {
  if (record.surface.empty()) return "<p>The scans can be seen only where WebGL is.</p>";
  const ordered_json& deviation = twin.at("deviation");
  const double limit_m =
      deviation.is_null() ? 1 : deviation.at("histogram").at("limit_m").get<double>();
  const View view = Portrait(record.surface, record.deviations_m, limit_m)
                        .oblique_view(picture_width_px, picture_height_px);
  return "<img alt=\"The surface seen from " + view.name +
         ", coloured by its signed deviation\" src=\"data:image/png;base64," +
         base64(png_bytes(view.image)) + "\">";
}

std::string radio(const std::string& value, const std::string& label) {
  return "<label><input type=\"radio\" name=\"colour\" value=\"" + value + "\"> " + label +
         "</label>";
}

std::string colour_choice(const RunRecord& record) {
  std::string html = "<fieldset><legend>Colour</legend>";
  if (!record.deviations_m.empty()) html += radio("deviation", "deviation");
  if (!record.surface.empty()) html += radio("normal", "normals");
  if (!record.support_m.empty()) html += radio("support", "support");
  if (!record.world_from_scan.empty()) html += radio("scan", "scans");
  return html + "</fieldset>";
}

std::string step_slider(std::size_t steps) {
  const std::string last = std::to_string(steps - 1);
  return "<div class=\"controls\"><button type=\"button\" id=\"play\">Play</button><label "
         "for=\"step\">alignment</label><input type=\"range\" id=\"step\" min=\"0\" max=\"" +
         last + "\" value=\"" + last +
         "\"><output id=\"step-name\" for=\"step\" aria-live=\"polite\"></output></div>\n";
}

std::string controls(const RunRecord& record) {
  std::string html = "<div class=\"controls\">" + colour_choice(record);
  if (!record.world_from_scan.empty())
    html += "<label><input type=\"checkbox\" id=\"scanners\"> scanners</label>";
  if (!record.deviations_m.empty())
    html += "<label><input type=\"checkbox\" id=\"pins\" checked> worst places</label>";
  html += "</div>\n<div class=\"controls\" role=\"group\" aria-label=\"Point of view\">";
  for (const char* side : {"front", "right", "back", "left", "top", "bottom", "oblique"})
    html += std::string("<button type=\"button\" data-view=\"") + side + "\">" + side + "</button>";
  html += "</div>\n";
  return record.world_from_scan.empty() ? html : html + step_slider(record.steps.size() + 1);
}

}  // namespace

std::vector<std::string_view> viewer_scripts() {
  std::vector<std::string_view> scripts(own_scripts.begin(), own_scripts.end());
  scripts.push_back(library);
  return scripts;
}

std::string viewer(const RunRecord& record, const ordered_json& twin, std::size_t most_points) {
  std::string html =
      "<div class=\"viewer no-webgl\" id=\"viewer\"><p class=\"screen guide\">Drag to turn, with "
      "the "
      "right button or two fingers to shift, wheel or pinch to come nearer. Keyboard: arrow keys "
      "turn, with Shift they shift, + and - zoom, Home goes back.</p>\n" +
      controls(record) + "<div class=\"stage\" id=\"stage\">" + picture(record, twin) +
      "<canvas id=\"canvas\" tabindex=\"0\" role=\"img\" hidden aria-label=\"Interactive 3D view "
      "of the surface and the scans; arrow keys turn it\"></canvas></div>\n"
      "<div class=\"key\" id=\"key\"></div><p class=\"quiet screen\" id=\"viewer-state\" "
      "role=\"status\">Without WebGL and scripts this is a picture.</p></div>\n";
  html += data_script("scene", scene_data(record, twin, most_points));
  html += "<script type=\"text/plain\" id=\"three-packed\">" + base64(deflated(asset(library))) +
          "</script>\n";
  for (const std::string_view script : own_scripts) html += inline_script(script);
  return html;
}

}  // namespace scan
