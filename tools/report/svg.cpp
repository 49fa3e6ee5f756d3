// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/console.h"
#include "tools/report/colour_map.h"

namespace scan {
namespace {

constexpr double width = 720, height = 240, left = 16, right = 16, top = 12, bottom = 44;
constexpr int bins = 72;

std::string hex(const Colour& c) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", c[0], c[1], c[2]);
  return text;
}

template <class... Numbers>
std::string print(const char* format, Numbers... numbers) {
  char text[512];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

std::string axis(double limit_m, double y) {
  std::string svg;
  for (int k = -2; k <= 2; ++k) {
    const double x = left + (width - left - right) * (k + 2) / 4;
    const char* anchor = k == -2 ? "start" : k == 2 ? "end" : "middle";
    svg += print("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#444'/>", x, y, x, y + 5);
    svg += print("<text x='%.1f' y='%.1f' text-anchor='%s'>%s</text>", x, y + 20, anchor,
                 readable_length(limit_m * k / 2).c_str());
  }
  return svg;
}

}  // namespace

std::string deviation_histogram(const std::vector<double>& deviations_m, double limit_m) {
  std::vector<std::size_t> counts(bins, 0);
  std::size_t outside = 0;
  for (const double d : deviations_m) {
    const double place = (d / limit_m + 1) / 2 * bins;
    if (place >= 0 && place < bins)
      ++counts[static_cast<std::size_t>(place)];
    else
      ++outside;
  }
  const double most = static_cast<double>(
      std::max<std::size_t>(1, *std::max_element(counts.begin(), counts.end())));
  const double floor = height - bottom, bar = (width - left - right) / bins;
  std::string svg = print(
      "<svg viewBox='0 0 %g %g' role='img' aria-label='Histogram of signed deviations' "
      "font-size='12' font-family='sans-serif'>",
      width, height);
  for (int i = 0; i < bins; ++i) {
    const double size =
        (floor - top) * static_cast<double>(counts[static_cast<std::size_t>(i)]) / most;
    svg += print(
        "<rect x='%.2f' y='%.2f' width='%.2f' height='%.2f' fill='%s' stroke='#555' "
        "stroke-width='0.3'/>",
        left + i * bar, floor - size, bar, size,
        hex(diverging_colour(2 * (i + 0.5) / bins - 1)).c_str());
  }
  svg += print("<line x1='%g' y1='%g' x2='%g' y2='%g' stroke='#444'/>", left, floor, width - right,
               floor);
  svg += axis(limit_m, floor);
  const double share = deviations_m.empty() ? 0
                                            : 100.0 * static_cast<double>(outside) /
                                                  static_cast<double>(deviations_m.size());
  svg += print(
      "<text x='%g' y='%g' text-anchor='middle'>signed deviation, %zu vertices; %.2f %% "
      "beyond the scale</text></svg>",
      width / 2, height - 6, deviations_m.size(), share);
  return svg;
}

std::string deviation_legend(double limit_m) {
  constexpr int steps = 60;
  std::string svg = print(
      "<svg viewBox='0 0 %g 44' role='img' aria-label='Colour scale' "
      "font-size='12' font-family='sans-serif'>",
      width);
  for (int i = 0; i < steps; ++i)
    svg += print("<rect x='%.2f' y='2' width='%.2f' height='16' fill='%s'/>",
                 left + (width - left - right) * i / steps, (width - left - right) / steps + 0.5,
                 hex(diverging_colour(2 * (i + 0.5) / steps - 1)).c_str());
  return svg + axis(limit_m, 18) + "</svg>";
}

}  // namespace scan
