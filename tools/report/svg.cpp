// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/svg.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

#include "tools/report/colour_map.h"
#include "tools/report/html.h"

namespace scan {
namespace {

constexpr double width = 760, height = 270, left = 16, right = 16, top = 40, bottom = 48;
constexpr double plot_width = width - left - right;

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

std::string page_length(double metres) {
  return page_value(metres, "m");
}

std::string axis(double limit_m, double y) {
  std::string svg;
  for (int k = -2; k <= 2; ++k) {
    const double x = left + plot_width * (k + 2) / 4;
    const char* anchor = k == -2 ? "start" : k == 2 ? "end" : "middle";
    svg += print("<line class='axis' x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f'/>", x, y, x, y + 5);
    svg += print("<text x='%.1f' y='%.1f' text-anchor='%s'>%s%s</text>", x, y + 20, anchor,
                 k > 0 ? "+" : "", k == 0 ? "0" : page_length(limit_m * k / 2).c_str());
  }
  return svg;
}

std::string bars(const DeviationHistogram& histogram, double floor) {
  const std::size_t bins = histogram.counts.size();
  const auto most = static_cast<double>(std::max<std::size_t>(
      1, *std::max_element(histogram.counts.begin(), histogram.counts.end())));
  const double bar = plot_width / static_cast<double>(bins);
  std::string svg;
  for (std::size_t i = 0; i < bins; ++i) {
    const double size = (floor - top) * static_cast<double>(histogram.counts[i]) / most;
    const double middle = 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(bins) - 1;
    svg += print("<rect class='edge' x='%.2f' y='%.2f' width='%.2f' height='%.2f' fill='%s'/>",
                 left + static_cast<double>(i) * bar, floor - size, bar, size,
                 hex(diverging_colour(middle)).c_str());
  }
  return svg;
}

// The names stand on the side of excess, one below the other.
std::string limit_lines(const DeviationHistogram& histogram,
                        const std::vector<HistogramLimit>& limits, double floor) {
  std::string svg;
  double row = 14;
  for (const HistogramLimit& limit : limits) {
    if (!(limit.value_m > 0) || limit.value_m > histogram.limit_m) continue;
    for (const double side : {-1.0, 1.0}) {
      const double x = left + plot_width * (1 + side * limit.value_m / histogram.limit_m) / 2;
      svg += print("<line class='limit' x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f'/>", x, row + 3, x,
                   floor);
      if (side > 0)
        svg += print("<text x='%.1f' y='%.1f' text-anchor='end'>", width - right, row) +
               escaped(limit.name + " " + page_length(limit.value_m)) + "</text>";
    }
    row += 15;
  }
  return svg;
}

constexpr double badge_distance_px = 22;  // from a place to the middle of its number

Eigen::Vector2d badge_place(const Eigen::Vector2d& place_px, double picture_px,
                            std::span<const Eigen::Vector2d> before) {
  constexpr double least_px = badge_radius_px + 1.5;
  Eigen::Vector2d away = place_px - Eigen::Vector2d::Constant(picture_px / 2);
  away = away.norm() > 0 ? Eigen::Vector2d(away.normalized()) : Eigen::Vector2d(0, -1);
  const auto turned = [&](int eighths) -> Eigen::Vector2d {
    const Eigen::Rotation2Dd turn(eighths * std::numbers::pi / 4);
    const Eigen::Vector2d place = place_px + badge_distance_px * (turn * away);
    return place.cwiseMax(least_px).cwiseMin(picture_px - least_px);
  };
  for (const int eighths : {0, 1, -1, 2, -2, 3, -3, 4}) {
    const Eigen::Vector2d place = turned(eighths);
    const auto is_clear = [&](const Eigen::Vector2d& other) {
      return (place - other).norm() >= 2 * badge_radius_px;
    };
    if (std::all_of(before.begin(), before.end(), is_clear)) return place;
  }
  return turned(0);
}

}  // namespace

std::vector<Eigen::Vector2d> badge_places(std::span<const Eigen::Vector2d> places_px,
                                          double picture_px) {
  std::vector<Eigen::Vector2d> badges;
  for (const Eigen::Vector2d& place : places_px)
    badges.push_back(badge_place(place, picture_px, badges));
  return badges;
}

std::string histogram_plot(const DeviationHistogram& histogram,
                           const std::vector<HistogramLimit>& limits) {
  const double floor = height - bottom;
  const std::size_t inside =
      std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::size_t{0});
  const std::size_t beyond = histogram.below + histogram.above, all = inside + beyond;
  const double share =
      all == 0 ? 0 : 100.0 * static_cast<double>(beyond) / static_cast<double>(all);
  return print(
             "<svg class='plot' viewBox='0 0 %g %g' role='img' aria-label='Histogram of signed "
             "deviations of %zu vertices; %.2f percent lie beyond the scale'>",
             width, height, all, share) +
         bars(histogram, floor) + limit_lines(histogram, limits, floor) +
         print("<line class='axis' x1='%g' y1='%g' x2='%g' y2='%g'/>", left, floor, width - right,
               floor) +
         axis(histogram.limit_m, floor) +
         print(
             "<text x='%g' y='%g' text-anchor='middle'>signed deviation of %zu vertices; %.2f "
             "%% lie beyond the scale</text></svg>\n",
             width / 2, height - 6, all, share);
}

std::string legend_plot(double limit_m) {
  constexpr int steps = 61;  // odd: one of them is white
  std::string svg = print(
      "<svg class='plot' viewBox='0 0 %g 46' role='img' aria-label='Colour scale from blue "
      "at -%s (inside) over white at 0 to red at +%s (outside); grey where unknown'>",
      width, page_length(limit_m).c_str(), page_length(limit_m).c_str());
  for (int i = 0; i < steps; ++i)
    svg += print("<rect x='%.2f' y='2' width='%.2f' height='18' fill='%s'/>",
                 left + plot_width * i / steps, plot_width / steps + 0.5,
                 hex(diverging_colour(2 * (i + 0.5) / steps - 1)).c_str());
  return svg + axis(limit_m, 20) + "</svg>\n";
}

std::string limit_bar(double share_of_limit, bool pass) {
  constexpr double whole = 100, end = 125;  // the limit's place and the bar's end
  if (!std::isfinite(share_of_limit)) return "";
  const double used = std::clamp(share_of_limit * whole, 0.0, end);
  return print(
      "<svg class='bar' viewBox='0 0 125 14' role='img' aria-label='%.0f percent of the "
      "limit'><rect class='track' width='125' height='14'/><rect class='%s' width='%.1f' "
      "height='14'/><line class='mark' x1='100' x2='100' y1='0' y2='14'/></svg>",
      share_of_limit * 100, pass ? "good" : "bad", used);
}

}  // namespace scan
