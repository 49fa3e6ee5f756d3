// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where the middle of the laser's plane truly meets the surface, row by row of the camera.
#include <cmath>
#include <limits>
#include <utility>

#include "libscan/core/parallel.h"
#include "synth/scanners/laser_line_optics.h"

namespace scan::synth {
namespace {

// Between two fan rays on both sides of an image row: the ray whose point is seen on that row, by
// regula falsi in its Illinois form (Dowell and Jarratt 1971). None where the surface breaks off.
std::optional<LitPoint> on_row(const LaserView& view, LitPoint a, LitPoint b, double row) {
  // the rounding of a pixel coordinate of a thousand, through ray, hit and projection
  constexpr double rounding_px = 1e-11;
  double a_px = a.pixel.y() - row, b_px = b.pixel.y() - row;
  if (std::abs(a_px) < rounding_px) return a;
  if (std::abs(b_px) < rounding_px) return b;
  int kept_before = 0;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double angle_rad = (a_px * b.angle_rad - b_px * a.angle_rad) / (a_px - b_px);
    const LitPoint middle = view.shine(angle_rad, 0);
    if (!middle.is_hit) return std::nullopt;
    const double middle_px = middle.pixel.y() - row;
    if (std::abs(middle_px) < rounding_px) return middle;
    const int kept = (middle_px < 0) == (a_px < 0) ? 1 : -1;  // the end that stays: b or a
    (kept > 0 ? a : b) = middle;
    (kept > 0 ? a_px : b_px) = middle_px;
    if (kept == kept_before) (kept > 0 ? b_px : a_px) /= 2;
    kept_before = kept;
    if (b.angle_rad - a.angle_rad < 1e-15) break;
  }
  const double a_rest = std::abs(a.pixel.y() - row), b_rest = std::abs(b.pixel.y() - row);
  if (std::min(a_rest, b_rest) > 1e-8) return std::nullopt;
  return a_rest < b_rest ? a : b;
}

bool is_seen(const LaserView& view, const LitPoint& point) {
  const Camera& camera = view.scanner.camera;
  if (!(point.pixel.x() >= -0.5 && point.pixel.x() <= camera.width_px - 0.5)) return false;
  // far outside a distorted image the projection folds back into it
  const auto ray = ray_through(camera, point.pixel);
  if (!ray || (*ray - point.x_in_camera / point.x_in_camera.z()).norm() > 1e-9) return false;
  return !view.caster.occluded(point.hit, view.world_from_camera.translation());
}

void true_rays_of_step(const LaserView& view, const Pose& scanner_from_camera, RayTruth* rays) {
  const LaserSheet& sheet = view.sheet;
  const int rows = view.scanner.camera.height_px;
  std::vector<double> nearest_m(rows, std::numeric_limits<double>::infinity());
  const int steps =
      std::max(2, static_cast<int>(std::ceil(2 * sheet.half_fan_rad / fan_step_rad(view.scanner))));
  LitPoint previous = view.shine(-sheet.half_fan_rad, 0);
  for (int i = 1; i <= steps; ++i) {
    const LitPoint next = view.shine(sheet.half_fan_rad * (2.0 * i / steps - 1), 0);
    const LitPoint before = std::exchange(previous, next);
    if (!before.is_hit || !next.is_hit) continue;
    const double low = std::min(before.pixel.y(), next.pixel.y());
    const double high = std::max(before.pixel.y(), next.pixel.y());
    for (int row = static_cast<int>(std::max(0.0, std::ceil(low)));
         row < rows && row <= high; ++row) {
      const auto point = on_row(view, before, next, row);
      if (!point || !is_seen(view, *point)) continue;
      const double distance_m = point->x_in_camera.norm();
      if (distance_m >= nearest_m[row]) continue;
      nearest_m[row] = distance_m;
      rays[row] = {scanner_from_camera * point->x_in_camera,
                   scanner_from_camera.linear() * view.world_from_camera.linear().transpose() *
                       point->hit.normal,
                   point->hit.object};
    }
  }
}

}  // namespace

std::vector<RayTruth> true_rays(const LaserLine& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  check(scanner);
  const LaserSheet sheet = laser_sheet(scanner);
  const std::vector<Pose> poses = scanner_from_camera(scanner);
  std::vector<RayTruth> rays(poses.size() * scanner.camera.height_px);
  parallel_for(
      poses.size(),
      [&](std::size_t step) {
        const LaserView view{scanner, sheet, caster, world_from_scanner * poses[step]};
        true_rays_of_step(view, poses[step], &rays[step * scanner.camera.height_px]);
      },
      1);
  return rays;
}

}  // namespace scan::synth
