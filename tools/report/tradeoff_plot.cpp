// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/tradeoff_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/console.h"
#include "tools/report/html.h"

namespace scan {
namespace {

constexpr double width = 760, height = 420, left = 90, right = 24, top = 20, bottom = 56;

// Distinct for the colour-blind too (Okabe and Ito 2008).
constexpr std::array<const char*, 7> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#000000"};

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
};

Axis axis_of(const std::vector<double>& values, double from, double to) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least / 1.25, *most * 1.25, from, to};
}

// Multiples of the powers of ten that lie on the axis: all on a short one, else by 1, 2 and 5.
std::vector<double> ticks(const Axis& axis) {
  const std::vector<double> digits = axis.high < 10 * axis.low
                                         ? std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}
                                         : std::vector<double>{1, 2, 5};
  std::vector<double> places;
  for (int power = static_cast<int>(std::floor(std::log10(axis.low)));
       std::pow(10, power) <= axis.high; ++power)
    for (const double digit : digits)
      if (const double tick = digit * std::pow(10, power); tick >= axis.low && tick <= axis.high)
        places.push_back(tick);
  return places;
}

std::string frame(const Axis& x, const Axis& y, const std::string& figure,
                  const std::string& unit) {
  std::string svg;
  for (const double tick : ticks(x)) {
    svg += print("<line x1='%.1f' y1='%g' x2='%.1f' y2='%g' class='grid'/>", x.at(tick), top,
                 x.at(tick), height - bottom);
    svg += print("<text x='%.1f' y='%g' text-anchor='middle'>%g</text>", x.at(tick),
                 height - bottom + 18, tick);
  }
  for (const double tick : ticks(y)) {
    svg += print("<line x1='%g' y1='%.1f' x2='%g' y2='%.1f' class='grid'/>", left, y.at(tick),
                 width - right, y.at(tick));
    svg += print("<text x='%g' y='%.1f' text-anchor='end'>%s</text>", left - 6, y.at(tick) + 4,
                 readable_value(tick, unit).c_str());
  }
  svg += print("<text x='%g' y='%g' text-anchor='middle'>seconds</text>",
               (left + width - right) / 2, height - 14);
  return svg +
         print("<text x='14' y='%g' text-anchor='middle' transform='rotate(-90 14 %g)'>%s</text>",
               (top + height - bottom) / 2, (top + height - bottom) / 2, escaped(figure).c_str());
}

std::string front_line(std::vector<TradeoffMark> marks, const Axis& x, const Axis& y) {
  std::sort(marks.begin(), marks.end(),
            [](const TradeoffMark& a, const TradeoffMark& b) { return a.seconds < b.seconds; });
  std::string points;
  for (const TradeoffMark& mark : marks)
    if (mark.on_front) points += print("%.1f,%.1f ", x.at(mark.seconds), y.at(mark.error));
  return "<polyline fill='none' stroke='#888' stroke-width='1.5' points='" + points + "'/>";
}

std::string drawn(const TradeoffMark& mark, const Axis& x, const Axis& y, const char* colour) {
  const double cx = x.at(mark.seconds), cy = y.at(mark.error);
  std::string svg = print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s'/>", cx,
                          y.at(mark.least_error), cx, y.at(mark.most_error), colour);
  if (mark.advised)
    svg += print("<circle cx='%.1f' cy='%.1f' r='10' fill='none' stroke='#111' stroke-width='2'/>",
                 cx, cy);
  return svg +
         print("<circle cx='%.1f' cy='%.1f' r='5' fill='%s'><title>", cx, cy,
               mark.on_front ? colour : "#fff") +
         escaped(mark.label) + "</title></circle>" +
         print("<circle cx='%.1f' cy='%.1f' r='5' fill='none' stroke='%s' stroke-width='1.5'/>", cx,
               cy, colour);
}

std::string legend(const std::vector<std::string>& curves) {
  std::string svg;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double y = top + 14 + 18 * static_cast<double>(i);
    svg += print("<circle cx='%g' cy='%g' r='5' fill='%s'/>", width - right - 10, y - 4,
                 colours[i % colours.size()]);
    svg += print("<text x='%g' y='%g' text-anchor='end'>", width - right - 20, y) +
           escaped(curves[i]) + "</text>";
  }
  return svg;
}

}  // namespace

std::string tradeoff_plot(const std::vector<TradeoffMark>& all, const std::string& figure,
                          const std::string& unit, double tolerance) {
  std::vector<TradeoffMark> marks;
  std::vector<double> seconds, errors;
  std::vector<std::string> curves;
  for (const TradeoffMark& mark : all) {
    if (!(mark.seconds > 0) || !(mark.least_error > 0) || !std::isfinite(mark.most_error)) continue;
    marks.push_back(mark);
    seconds.push_back(mark.seconds);
    errors.insert(errors.end(), {mark.least_error, mark.most_error});
    if (std::find(curves.begin(), curves.end(), mark.curve) == curves.end())
      curves.push_back(mark.curve);
  }
  if (marks.empty()) return "<p>No run gave an error to show.</p>";
  if (tolerance > 0) errors.push_back(tolerance);
  const Axis x = axis_of(seconds, left, width - right), y = axis_of(errors, height - bottom, top);
  std::string svg =
      print("<svg class='plot' viewBox='0 0 %g %g' role='img' aria-label='Error against seconds'>",
            width, height);
  svg += frame(x, y, figure, unit) + front_line(marks, x, y);
  if (tolerance > 0)
    svg += print(
        "<line x1='%g' y1='%.1f' x2='%g' y2='%.1f' stroke='#a11a2b' stroke-dasharray='6 4'/>"
        "<text x='%g' y='%.1f' fill='#a11a2b'>tolerance</text>",
        left, y.at(tolerance), width - right, y.at(tolerance), left + 6, y.at(tolerance) - 5);
  for (const TradeoffMark& mark : marks) {
    const auto curve = std::find(curves.begin(), curves.end(), mark.curve) - curves.begin();
    svg += drawn(mark, x, y, colours[static_cast<std::size_t>(curve) % colours.size()]);
  }
  return svg + legend(curves) + "</svg>";
}

}  // namespace scan
