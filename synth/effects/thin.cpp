// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/thin.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

constexpr int least_side = 8;

int fewer(int count, double factor) {
  return std::clamp(static_cast<int>(std::lround(count / factor)), std::min(count, least_side),
                    count);
}

// Pixels `factor` times as wide; the field of view stays.
Camera coarser(Camera camera, double factor) {
  const int width = fewer(camera.width_px, factor), height = fewer(camera.height_px, factor);
  const double across = static_cast<double>(width) / camera.width_px;
  const double down = static_cast<double>(height) / camera.height_px;
  camera.cx_px = (camera.cx_px + 0.5) * across - 0.5;
  camera.cy_px = (camera.cy_px + 0.5) * down - 0.5;
  camera.fx_px *= across;
  camera.fy_px *= down;
  camera.width_px = width;
  camera.height_px = height;
  return camera;
}

// The stripe must stay as wide in pixels, so only steps are left out.
double rays_of(const LaserLine& s) {
  return 1.0 * s.steps * s.camera.height_px;
}
Scanner thin(LaserLine s, double factor) {
  const int steps = std::max(1, static_cast<int>(std::lround(s.steps / factor)));
  const double stride = static_cast<double>(s.steps) / steps;
  s.step_m *= stride;
  s.turn_rad *= stride;
  s.steps = steps;
  return s;
}

// Disparities keep their size in pixels, or the matcher would see another scene: rows are left out
// from above and below alike.
double rays_of(const StereoPair& s) {
  return 1.0 * s.calibration.width_px * s.calibration.height_px;
}
Scanner thin(StereoPair s, double factor) {
  const int rows = fewer(s.calibration.height_px, factor);
  s.calibration.cy_px -= (s.calibration.height_px - rows) / 2;
  s.calibration.height_px = rows;
  return s;
}

double rays_of(const PhaseCamera& s) {
  return 1.0 * s.camera.width_px * s.camera.height_px;
}
Scanner thin(PhaseCamera s, double factor) {
  s.camera = coarser(s.camera, std::sqrt(factor));
  return s;
}

double rays_of(const PulsedLidar& s) {
  return std::visit([](const auto& p) { return 1.0 * p.rows * p.columns; }, s.pattern);
}
// Rows first: what is thin and upright is met by a whole column or by none. As long as before, so
// that a moving scanner goes as far.
Scanner thin(PulsedLidar s, double factor) {
  const double before = rays_of(s);
  std::visit(
      [&](auto& p) {
        const int rows = fewer(p.rows, factor);
        p.columns = fewer(p.columns, std::max(1.0, factor * rows / p.rows));
        p.rows = rows;
      },
      s.pattern);
  s.motion.interval_s *= before / rays_of(s);
  return s;
}

}  // namespace

double ray_count(const Scanner& scanner) {
  return std::visit([](const auto& s) { return rays_of(s); }, scanner);
}

Scanner thinned(const Scanner& scanner, double rays) {
  const double factor = std::max(1.0, ray_count(scanner) / std::max(1.0, rays));
  return std::visit([&](const auto& s) { return thin(s, factor); }, scanner);
}

}  // namespace scan::synth
