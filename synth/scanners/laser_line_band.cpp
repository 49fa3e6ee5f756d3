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

#include "synth/scanners/laser_line_optics.h"

namespace scan::synth {
namespace {

constexpr double near_px = 3;  // neighbours so close need no ray between them
constexpr int margin_px =
    2;  // what four such neighbours enclose is at most 1.5 px from their sides
constexpr int halvings = 10;

struct Band {
  const LaserView& view;
  Image<std::uint8_t> mask;

  void mark(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    // pixels of absurd size, of points just before the camera's plane, stay outside
    const auto limit = [](double v, int size) { return std::clamp(v, -10.0, size + 10.0); };
    const int left = static_cast<int>(std::floor(limit(low.x(), mask.width))) - margin_px;
    const int right = static_cast<int>(std::ceil(limit(high.x(), mask.width))) + margin_px;
    const int top = static_cast<int>(std::floor(limit(low.y(), mask.height))) - margin_px;
    const int bottom = static_cast<int>(std::ceil(limit(high.y(), mask.height))) + margin_px;
    for (int row = std::max(0, top); row <= std::min(mask.height - 1, bottom); ++row)
      for (int column = std::max(0, left); column <= std::min(mask.width - 1, right); ++column)
        mask(column, row) = 1;
  }

  void mark_between(const LitPoint& a, const LitPoint& b, int depth) {
    if (!a.is_hit && !b.is_hit) return;
    if (a.is_hit && b.is_hit && (a.pixel - b.pixel).cwiseAbs().maxCoeff() <= near_px)
      return mark(a.pixel.cwiseMin(b.pixel), a.pixel.cwiseMax(b.pixel));
    if (depth == 0) {
      if (a.is_hit) mark(a.pixel, a.pixel);
      if (b.is_hit) mark(b.pixel, b.pixel);
      return;
    }
    const LitPoint middle =
        view.shine((a.angle_rad + b.angle_rad) / 2, (a.from_plane_m + b.from_plane_m) / 2);
    mark_between(a, middle, depth - 1);
    mark_between(middle, b, depth - 1);
  }
};

// Odd, and so many that neighbours at the focus are at most a pixel apart.
int sheet_count(const LaserView& view) {
  const double z = view.scanner.baseline_m / std::tan(view.scanner.triangulation_rad);
  const double half_width_px =
      view.sheet.reach_m / view.sheet.normal.x() / z * view.scanner.camera.fx_px;
  return 1 + 2 * std::clamp(static_cast<int>(std::ceil(half_width_px)), 1, 1000);
}

}  // namespace

Image<std::uint8_t> lit_band(const LaserView& view) {
  const Camera& camera = view.scanner.camera;
  Band band{view, Image<std::uint8_t>(camera.width_px, camera.height_px)};
  const LaserSheet& sheet = view.sheet;
  const int steps = fan_steps(view.scanner, 1), sheets = sheet_count(view);
  std::vector<LitPoint> previous;
  for (int i = 0; i <= steps; ++i) {
    const double angle_rad = sheet.half_fan_rad * (2.0 * i / steps - 1);
    std::vector<LitPoint> across;
    for (int k = 0; k < sheets; ++k) {
      across.push_back(view.shine(angle_rad, sheet.reach_m * (2.0 * k / (sheets - 1) - 1)));
      if (k > 0) band.mark_between(across[k - 1], across[k], halvings);
      if (i > 0) band.mark_between(previous[k], across[k], halvings);
    }
    previous = std::move(across);
  }
  return std::move(band.mask);
}

}  // namespace scan::synth
