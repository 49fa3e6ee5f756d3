// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/deviation_map.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/report/figure_tables.h"
#include "tools/report/html.h"
#include "tools/report/picture.h"
#include "tools/report/svg.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

constexpr int view_px = 320;
constexpr double seen_within_px = 2;

struct Mark {
  std::string number;
  Eigen::Vector2d at_px;
};

// For each view what to mark on it: each place where it faces the viewer most of the views that see
// it.
std::vector<std::vector<Mark>> marks_of(const std::vector<View>& views, const Portrait& portrait,
                                        const RunRecord& record, const ordered_json& call_outs) {
  std::vector<std::vector<Mark>> marks(views.size());
  const auto normals = vertex_normals(record.surface);
  const auto& vertices = record.surface.vertices;
  for (const auto& place : call_outs) {
    const auto at = place.at("position_m").get<std::array<double, 3>>();
    const Eigen::Vector3d point(at.data());
    const auto vertex = std::find(vertices.begin(), vertices.end(), point) - vertices.begin();
    std::size_t best = views.size();
    double most = -2;
    for (std::size_t k = 0; k < views.size(); ++k) {
      const double facing = normals[static_cast<std::size_t>(vertex)].dot(views[k].towards_viewer);
      if (facing > most && portrait.is_seen(views[k], point, seen_within_px * views[k].pixel_m))
        best = k, most = facing;
    }
    if (best < views.size())
      marks[best].push_back({place.at("number").dump(), views[best].place(point)});
  }
  return marks;
}

// A ring on the place and its number beside it.
std::string drawn(const Mark& mark, const Eigen::Vector2d& badge) {
  char text[512];
  std::snprintf(text, sizeof text,
                "<circle cx='%.1f' cy='%.1f' r='4' fill='none' stroke='#111' stroke-width='1.6'/>"
                "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#111'/>"
                "<circle cx='%.1f' cy='%.1f' r='%.1f' fill='#fff' stroke='#111'/>"
                "<text x='%.1f' y='%.1f' text-anchor='middle' font-size='12' "
                "font-weight='700'>%s</text>",
                mark.at_px.x(), mark.at_px.y(), mark.at_px.x(), mark.at_px.y(), badge.x(),
                badge.y(), badge.x(), badge.y(), badge_radius_px, badge.x(), badge.y() + 4.2,
                mark.number.c_str());
  return text;
}

std::string figure(const View& view, const std::vector<Mark>& marks, bool coloured) {
  std::string alt =
      "The surface seen from " + view.name + (coloured ? ", coloured by its signed deviation" : "");
  std::string svg;
  std::vector<Eigen::Vector2d> places;
  for (const Mark& mark : marks) places.push_back(mark.at_px);
  const std::vector<Eigen::Vector2d> badges = badge_places(places, view_px);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    alt += (i == 0 ? "; worst deviations marked on it: " : ", ") + marks[i].number;
    svg += drawn(marks[i], badges[i]);
  }
  const std::string size = std::to_string(view_px);
  return "<figure><div class=\"view\"><img width=\"" + size + "\" height=\"" + size + "\" alt=\"" +
         escaped(alt) + "\" src=\"data:image/png;base64," + base64(png_bytes(view.image)) +
         "\"><svg aria-hidden=\"true\" viewBox=\"0 0 " + size + " " + size + "\">" + svg +
         "</svg></div><figcaption>" + escaped(view.name) + "</figcaption></figure>\n";
}

}  // namespace

std::string deviation_map(const RunRecord& record, const ordered_json& twin) {
  if (record.surface.empty()) return "";
  const ordered_json& deviation = twin.at("deviation");
  const bool coloured = !deviation.is_null();
  const double limit_m = coloured ? deviation.at("histogram").at("limit_m").get<double>() : 1;
  const ordered_json call_outs = coloured ? deviation.at("call_outs") : ordered_json::array();
  std::string html =
      coloured ? "<p>Signed distance of the reconstructed surface from the true one: blue lies "
                 "inside, red outside. The scale holds 99 % of the vertices; what lies beyond has "
                 "the colour of its end; grey is unknown. Numbers mark the worst places.</p>" +
                     legend_plot(limit_m)
               : "<p>No truth, so no deviation: the surface in plain clay.</p>";
  const Portrait portrait(record.surface, record.deviations_m, limit_m);
  html += "<div class=\"views\">";
  const std::vector<View> views = portrait.six_views(view_px);
  const auto marks = marks_of(views, portrait, record, call_outs);
  for (std::size_t k = 0; k < views.size(); ++k) html += figure(views[k], marks[k], coloured);
  return html + "</div>" + call_out_table(call_outs);
}

}  // namespace scan
