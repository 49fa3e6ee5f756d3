// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/basins_figures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace scan::test {
namespace {

constexpr double panel_width = 300, panel_height = 220, left = 48, top = 28, gap = 34;
constexpr double legend_height = 78, bottom = 46;
constexpr double most_turn_deg = 30, most_shift_percent = 20;
constexpr double least_s = 1e-3, most_s = 10;

constexpr std::array colours = {"#d62728", "#1f77b4", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b",
                                "#17becf", "#7f7f7f", "#e377c2", "#bcbd22", "#000000"};

template <class... Numbers>
std::string print(const char* format, Numbers... numbers) {
  char text[512];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

struct Point {
  double x = 0, y = 0, low = 0, high = 0;  // shares; low == high: no bar
};
struct Curve {
  std::string name;
  std::vector<Point> points;
};
struct Panel {
  std::string title;
  std::vector<Curve> curves;
};
struct Axis {
  std::string title;
  double least = 0, most = 1;
  bool logarithmic = false;
  std::vector<double> ticks;
  double place(double x) const {
    return logarithmic ? std::log(x / least) / std::log(most / least)
                       : (x - least) / (most - least);
  }
};

// libscan's lines are whole, PCL's and Open3D's broken.
const char* dashes(const std::string& name) {
  if (name.starts_with("PCL")) return " stroke-dasharray='7 3'";
  if (name.starts_with("Open3D")) return " stroke-dasharray='2 2'";
  return "";
}

std::string frame(const Panel& panel, const Axis& axis, double x0, double y0) {
  std::string svg = print(
      "<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='none' "
      "stroke='#444'/><text x='%.1f' y='%.1f' text-anchor='middle'>%s</text>",
      x0, y0, panel_width, panel_height, x0 + panel_width / 2, y0 - 8, panel.title.c_str());
  for (int k = 0; k <= 4; ++k) {
    const double y = y0 + panel_height * (1 - k / 4.0);
    svg += print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#ddd'/>", x0, y,
                 x0 + panel_width, y);
    svg += print("<text x='%.1f' y='%.1f' text-anchor='end'>%d %%</text>", x0 - 4, y + 4, 25 * k);
  }
  for (const double tick : axis.ticks)
    svg += print("<text x='%.1f' y='%.1f' text-anchor='middle'>%g</text>",
                 x0 + panel_width * axis.place(tick), y0 + panel_height + 15, tick);
  return svg + print("<text x='%.1f' y='%.1f' text-anchor='middle'>%s</text>", x0 + panel_width / 2,
                     y0 + panel_height + 31, axis.title.c_str());
}

std::string line(const Curve& curve, const Axis& axis, std::size_t k, double x0, double y0) {
  const char* colour = colours[k % colours.size()];
  std::string path, bars;
  for (const Point& point : curve.points) {
    const double x = x0 + panel_width * axis.place(point.x);
    path += print("%.1f,%.1f ", x, y0 + panel_height * (1 - point.y));
    if (point.low < point.high)
      bars += print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s' opacity='0.5'/>", x,
                    y0 + panel_height * (1 - point.low), x, y0 + panel_height * (1 - point.high),
                    colour);
  }
  return bars +
         print("<polyline fill='none' stroke='%s' stroke-width='1.8'%s points='", colour,
               dashes(curve.name)) +
         path + "'/>";
}

std::string legend(const std::vector<Curve>& curves, double width) {
  std::string svg;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const double x = left + double(k % 4) * (width - left) / 4, y = 14 + 20 * double(k / 4);
    svg += print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s' stroke-width='2'%s/>",
                 x, y, x + 30, y, colours[k % colours.size()], dashes(curves[k].name));
    svg += print("<text x='%.1f' y='%.1f'>%s</text>", x + 36, y + 4, curves[k].name.c_str());
  }
  return svg;
}

// Two panels to a row, under the legend.
std::string figure(const std::vector<Panel>& panels, const Axis& axis) {
  const double width = 2 * (left + panel_width) + gap;
  const double row = top + panel_height + bottom;
  const double height = legend_height + row * double((panels.size() + 1) / 2);
  std::string svg = print(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %g %g' "
      "font-size='11' font-family='sans-serif'>"
      "<rect width='100%%' height='100%%' fill='white'/>",
      width, height);
  if (!panels.empty()) svg += legend(panels[0].curves, width);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const double x0 = left + double(p % 2) * (left + panel_width);
    const double y0 = legend_height + top + row * double(p / 2);
    svg += frame(panels[p], axis, x0, y0);
    for (std::size_t k = 0; k < panels[p].curves.size(); ++k)
      svg += line(panels[p].curves[k], axis, k, x0, y0);
  }
  return svg + "</svg>\n";
}

// curve(overlap, method) for all of them, the largest overlap first.
template <class MakeCurve>
std::vector<Panel> panels_of(const std::vector<Trial>& trials, MakeCurve&& curve) {
  std::vector<Panel> panels;
  const auto overlaps = values_of(trials, &Trial::overlap);
  for (auto overlap = overlaps.rbegin(); overlap != overlaps.rend(); ++overlap) {
    panels.push_back({print("overlap %.0f %%", 100 * *overlap), {}});
    for (const std::string& method : values_of(trials, &Trial::method))
      panels.back().curves.push_back({method, curve(*overlap, method)});
  }
  return panels;
}

}  // namespace

std::string success_figure(const std::vector<Trial>& trials, double Trial::*offset,
                           const std::string& title) {
  Axis axis{.title = title, .ticks = values_of(trials, offset)};
  std::erase(axis.ticks, 0);
  axis.most = axis.ticks.back();
  const auto panels = panels_of(trials, [&](double overlap, const std::string& method) {
    std::vector<Point> points;
    for (const double x : axis.ticks) {
      const Share solved = share_of(
          trials,
          [&](const Trial& trial) {
            return trial.overlap == overlap && trial.method == method && trial.*offset == x;
          },
          is_solved);
      points.push_back({x, solved.value(), solved.low(), solved.high()});
    }
    return points;
  });
  return figure(panels, axis);
}

std::string time_figure(const std::vector<Trial>& trials) {
  const Axis axis{.title = "processor seconds",
                  .least = least_s,
                  .most = most_s,
                  .logarithmic = true,
                  .ticks = {0.001, 0.01, 0.1, 1, 10}};
  const auto panels = panels_of(trials, [&](double overlap, const std::string& method) {
    std::vector<Point> points;
    for (double s = least_s; s < 1.01 * most_s; s *= std::pow(10, 0.1)) {
      const Share within = share_of(
          trials,
          [&](const Trial& trial) {
            return trial.overlap == overlap && trial.method == method &&
                   trial.turn_deg <= most_turn_deg && trial.shift_percent <= most_shift_percent;
          },
          [&](const Trial& trial) { return is_solved(trial) && trial.seconds <= s; });
      points.push_back({s, within.value()});
    }
    return points;
  });
  return figure(panels, axis);
}

}  // namespace scan::test
