// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/tradeoff_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "tools/console.h"
#include "tools/report/html.h"

namespace scan {
namespace {

constexpr double page_width = 760, wide_height = 420, narrow_height = 300, legend_height = 26;

// Distinct for the colour-blind too (Okabe and Ito 2008).
constexpr std::array<const char*, 8> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#000000", "#8a8a8a"};

template <class... Numbers>
std::string print(const char* format, Numbers... numbers) {
  char text[512];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

// A logarithmic axis that holds its values with a little room.
struct Axis {
  double low = 1, high = 10;
  double from = 0, to = 0;  // where its ends lie on the page

  double at(double value) const {
    return from + (to - from) * std::log(value / low) / std::log(high / low);
  }
  Axis between(double begin, double end) const { return {low, high, begin, end}; }
};

Axis axis_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least / 1.25, *most * 1.25, 0, 0};
}

// Multiples of the powers of ten that lie on the axis, as many as its length has room for.
std::vector<double> ticks(const Axis& axis) {
  const double decade_px = std::abs(axis.to - axis.from) / std::log10(axis.high / axis.low);
  const std::vector<double> digits = decade_px > 420   ? std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}
                                     : decade_px > 150 ? std::vector<double>{1, 2, 5}
                                                       : std::vector<double>{1};
  std::vector<double> places;
  for (int power = static_cast<int>(std::floor(std::log10(axis.low)));
       std::pow(10, power) <= axis.high; ++power)
    for (const double digit : digits)
      if (const double tick = digit * std::pow(10, power); tick >= axis.low && tick <= axis.high)
        places.push_back(tick);
  return places;
}

std::string centred(double x, double y, const std::string& text) {
  return print("<text x='%.1f' y='%.1f' text-anchor='middle'>", x, y) + escaped(text) + "</text>";
}

std::string frame(const Axis& x, const Axis& y, const TradeoffLabels& labels,
                  const std::string& title) {
  std::string svg;
  for (const double tick : ticks(x)) {
    svg += print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' class='grid' stroke='#ddd'/>",
                 x.at(tick), y.to, x.at(tick), y.from);
    svg += centred(x.at(tick), y.from + 18, print("%g", tick));
  }
  for (const double tick : ticks(y)) {
    svg += print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' class='grid' stroke='#ddd'/>",
                 x.from, y.at(tick), x.to, y.at(tick));
    svg += print("<text x='%.1f' y='%.1f' text-anchor='end'>%s</text>", x.from - 6, y.at(tick) + 4,
                 readable_value(tick, labels.unit).c_str());
  }
  const double middle = (y.from + y.to) / 2, turn_x = x.from - 72;
  svg += centred((x.from + x.to) / 2, y.from + 38, labels.seconds) +
         print("<g transform='rotate(-90 %.1f %.1f)'>", turn_x, middle) +
         centred(turn_x, middle, labels.figure) + "</g>";
  if (!title.empty())
    svg += "<g font-weight='bold'>" + centred((x.from + x.to) / 2, y.to - 8, title) + "</g>";
  return svg;
}

// Through the curve's own front: what it can at best for so many seconds.
std::string line_through(std::vector<TradeoffMark> marks, const Axis& x, const Axis& y,
                         const char* colour) {
  std::sort(marks.begin(), marks.end(), [](const TradeoffMark& a, const TradeoffMark& b) {
    return std::pair(a.seconds, a.error) < std::pair(b.seconds, b.error);
  });
  std::string points;
  double best = std::numeric_limits<double>::infinity();
  for (const TradeoffMark& mark : marks) {
    if (!(mark.error < best)) continue;
    best = mark.error;
    points += print("%.1f,%.1f ", x.at(mark.seconds), y.at(mark.error));
  }
  return print("<polyline fill='none' stroke='%s' stroke-opacity='.45' points='", colour) + points +
         "'/>";
}

std::string drawn(const TradeoffMark& mark, const Axis& x, const Axis& y, const char* colour) {
  const double cx = x.at(mark.seconds), cy = y.at(mark.error);
  std::string svg = print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s'/>", cx,
                          y.at(mark.least_error), cx, y.at(mark.most_error), colour);
  if (mark.advised)
    svg += print("<circle cx='%.1f' cy='%.1f' r='10' fill='none' stroke='#111' stroke-width='2'/>",
                 cx, cy);
  return svg +
         print("<circle cx='%.1f' cy='%.1f' r='5' fill='%s' stroke='%s' stroke-width='1.5'><title>",
               cx, cy, mark.on_front ? colour : "#fff", colour) +
         escaped(mark.label) + "</title></circle>";
}

// In rows below the panels.
std::string legend(const std::vector<std::string>& curves, double top, double& bottom) {
  std::string svg;
  double x = 90, y = top + 16;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double width = 30 + 7.2 * static_cast<double>(curves[i].size());
    if (x + width > page_width) {
      x = 90;
      y += 20;
    }
    svg += print("<circle cx='%.1f' cy='%.1f' r='5' fill='%s'/>", x, y - 4,
                 colours[i % colours.size()]);
    svg += print("<text x='%.1f' y='%.1f'>", x + 10, y) + escaped(curves[i]) + "</text>";
    x += width;
  }
  bottom = y + legend_height - 16;
  return svg;
}

template <class Member>
std::vector<std::string> names_of(const std::vector<TradeoffMark>& marks, Member member) {
  std::vector<std::string> names;
  for (const TradeoffMark& mark : marks)
    if (std::find(names.begin(), names.end(), mark.*member) == names.end())
      names.push_back(mark.*member);
  return names;
}

std::string panel(const std::vector<TradeoffMark>& marks, const std::vector<std::string>& curves,
                  const Axis& x, const Axis& y, double tolerance) {
  std::string lines, dots;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const char* const colour = colours[i % colours.size()];
    std::vector<TradeoffMark> of_curve;
    for (const TradeoffMark& mark : marks)
      if (mark.curve == curves[i]) of_curve.push_back(mark);
    lines += line_through(of_curve, x, y, colour);
    for (const TradeoffMark& mark : of_curve) dots += drawn(mark, x, y, colour);
  }
  if (tolerance > 0)
    lines += print(
        "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#a11a2b' stroke-dasharray='6 4'/>"
        "<text x='%.1f' y='%.1f' fill='#a11a2b'>tolerance</text>",
        x.from, y.at(tolerance), x.to, y.at(tolerance), x.from + 6, y.at(tolerance) - 5);
  return lines + dots;
}

bool can_be_shown(const TradeoffMark& mark) {
  return mark.seconds > 0 && mark.least_error > 0 && std::isfinite(mark.most_error);
}

}  // namespace

std::string tradeoff_plot(const std::vector<TradeoffMark>& all, const TradeoffLabels& labels,
                          double tolerance) {
  std::vector<TradeoffMark> marks;
  std::copy_if(all.begin(), all.end(), std::back_inserter(marks), can_be_shown);
  std::vector<double> seconds, errors;
  for (const TradeoffMark& mark : marks) {
    seconds.push_back(mark.seconds);
    errors.insert(errors.end(), {mark.least_error, mark.most_error});
  }
  if (tolerance > 0) errors.push_back(tolerance);
  const auto panels = names_of(marks, &TradeoffMark::panel);
  const auto curves = names_of(marks, &TradeoffMark::curve);
  const bool is_single = panels.size() < 2;
  const double width = is_single ? page_width : page_width / 2;
  const double height = is_single ? wide_height : narrow_height;
  std::string svg;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double left = static_cast<double>(i % 2) * width,
                 top = static_cast<double>(i / 2) * height;
    const Axis x = axis_of(seconds).between(left + 90, left + width - 20);
    const Axis y = axis_of(errors).between(top + height - 56, top + 26);
    std::vector<TradeoffMark> inside;
    std::copy_if(marks.begin(), marks.end(), std::back_inserter(inside),
                 [&](const TradeoffMark& mark) { return mark.panel == panels[i]; });
    svg += frame(x, y, labels, panels[i]) + panel(inside, curves, x, y, tolerance);
  }
  double bottom = 0;
  const std::size_t in_row = is_single ? 1 : 2, rows = (panels.size() + in_row - 1) / in_row;
  svg += legend(curves, height * static_cast<double>(rows), bottom);
  return print(
             "<svg class='plot' xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %g %.0f' "
             "role='img' "
             "aria-label='Error against seconds' font-size='12' font-family='sans-serif'>",
             page_width, bottom) +
         (marks.empty() ? centred(page_width / 2, 40, "No run gave an error to show.") : svg) +
         "</svg>";
}

}  // namespace scan
