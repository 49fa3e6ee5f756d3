// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where in the image the stripe can be: the laser's light is followed forwards, so that camera rays
// need be traced along the stripe only.
//
// Every lit point is the first hit of a ray of the sheet. Rays over the fan and the sheet's
// thickness are shone onto the scene and seen by the camera; where neighbours land far apart, rays
// between them follow, down to 1/1024 of their gap, so that surfaces lit at a grazing angle are
// covered up to the limb.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "synth/scanners/laser_line_samples.h"

namespace scan::synth {
namespace {

constexpr double near_px = 3;         // neighbours so close need no ray between them
constexpr double near_margin_px = 2;  // four such neighbours enclose at most 1.5 px to their sides
constexpr int halvings = 10;
constexpr int most_planes = 10000;  // to each side

struct Band {
  const LaserView& view;
  Image<std::uint8_t> mask;

  SheetHit shine(double angle_rad, double from_plane_m, double time_steps) const {
    if (time_steps == 0) return view.shine(angle_rad, from_plane_m);
    SheetHit point = view.after(time_steps).shine(angle_rad, from_plane_m);
    point.time_steps = time_steps;
    return point;
  }

  void mark(const SheetHit& a, const SheetHit& b) {
    // pixels of absurd size, of points just before the camera's plane, stay outside
    const auto limit = [](double v, int size) { return std::clamp(v, -10.0, size + 10.0); };
    const double margin_px =
        near_margin_px + std::max(blur_radius_px(view.scanner, a.x_in_camera.z()),
                                  blur_radius_px(view.scanner, b.x_in_camera.z()));
    const Eigen::Vector2d low = a.pixel.cwiseMin(b.pixel).array() - margin_px;
    const Eigen::Vector2d high = a.pixel.cwiseMax(b.pixel).array() + margin_px;
    const int left = static_cast<int>(std::floor(limit(low.x(), mask.width)));
    const int right = static_cast<int>(std::ceil(limit(high.x(), mask.width)));
    const int top = static_cast<int>(std::floor(limit(low.y(), mask.height)));
    const int bottom = static_cast<int>(std::ceil(limit(high.y(), mask.height)));
    for (int row = std::max(0, top); row <= std::min(mask.height - 1, bottom); ++row)
      for (int column = std::max(0, left); column <= std::min(mask.width - 1, right); ++column)
        mask(column, row) = 1;
  }

  void mark_between(const SheetHit& a, const SheetHit& b, int depth) {
    if (!a.is_hit && !b.is_hit) return;
    if (a.is_hit && b.is_hit && (a.pixel - b.pixel).cwiseAbs().maxCoeff() <= near_px) {
      if (a.is_lit || b.is_lit) mark(a, b);
      return;
    }
    if (depth == 0) {
      if (a.is_lit) mark(a, a);
      if (b.is_lit) mark(b, b);
      return;
    }
    const SheetHit middle =
        shine((a.angle_rad + b.angle_rad) / 2, (a.from_plane_m + b.from_plane_m) / 2,
              (a.time_steps + b.time_steps) / 2);
    mark_between(a, middle, depth - 1);
    mark_between(middle, b, depth - 1);
  }
};

// The fan's rays in a plane parallel to the light plane, at one time.
using Line = std::vector<SheetHit>;

// Lines of one plane at the times given; what lies between the rays and the times is marked.
std::vector<Line> shine_lines(Band& band, double from_plane_m, const std::vector<double>& times) {
  const LaserSheet& sheet = band.view.sheet;
  const int steps = fan_steps(band.view.scanner, 1);
  std::vector<Line> lines;
  for (const double time : times) {
    Line line;
    for (int i = 0; i <= steps; ++i) {
      line.push_back(band.shine(sheet.half_fan_rad * (2.0 * i / steps - 1), from_plane_m, time));
      if (i > 0) band.mark_between(line[i - 1], line[i], halvings);
      if (!lines.empty()) band.mark_between(lines.back()[i], line[i], halvings);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

// How far from the plane the beam reaches on what the lines hit.
double reach_m(const LaserSheet& sheet, const std::vector<Line>& lines) {
  double reach = sheet.reach_radii * sheet.waist_m;
  for (const Line& line : lines)
    for (const SheetHit& point : line)
      if (point.is_hit)
        reach = std::max(reach, sheet.reach_radii * sheet.radius_m(point.hit.distance_m));
  return reach;
}

// Planes to each side up to the waist's reach: so many that neighbours at the focus are at most a
// pixel apart.
int plane_count(const LaserView& view) {
  const double z = view.scanner.baseline_m / std::tan(view.scanner.triangulation_rad);
  const double half_width_px = view.sheet.reach_radii * view.sheet.waist_m / view.sheet.normal.x() /
                               z * view.scanner.camera.fx_px;
  return std::clamp(static_cast<int>(std::ceil(half_width_px)), 1, 1000);
}

}  // namespace

// Planes are added outwards until the beam reaches no farther on anything that they hit.
Image<std::uint8_t> lit_band(const LaserView& view) {
  const Camera& camera = view.scanner.camera;
  Band band{view, Image<std::uint8_t>(camera.width_px, camera.height_px)};
  const LaserSheet& sheet = view.sheet;
  const double half_share = view.scanner.exposure_share / 2;
  const std::vector<double> times =
      half_share > 0 ? std::vector<double>{-half_share, half_share} : std::vector<double>{0.0};
  const double gap_m = sheet.reach_radii * sheet.waist_m / plane_count(view);
  const std::vector<Line> middle = shine_lines(band, 0, times);
  for (const int side : {-1, 1}) {
    std::vector<Line> inner = middle;
    double reach = reach_m(sheet, middle);
    for (int k = 1; k <= most_planes && (k - 1) * gap_m < reach * (1 - 1e-9); ++k) {
      std::vector<Line> outer = shine_lines(band, side * k * gap_m, times);
      for (std::size_t t = 0; t < outer.size(); ++t)
        for (std::size_t i = 0; i < outer[t].size(); ++i)
          band.mark_between(inner[t][i], outer[t][i], halvings);
      reach = std::max(reach, reach_m(sheet, outer));
      inner = std::move(outer);
    }
  }
  return std::move(band.mask);
}

}  // namespace scan::synth
