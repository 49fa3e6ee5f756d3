// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where the middle of the laser's plane truly meets the surface, row by row of the camera.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "libscan/core/parallel.h"
#include "synth/scanners/laser_line_optics.h"

namespace scan::synth {
namespace {

// Between two fan rays on both sides of an image row: the ray whose point is seen on that row, by
// regula falsi in its Illinois form (Dowell and Jarratt 1971). None where the surface breaks off.
std::optional<SheetHit> on_row(const LaserView& view, SheetHit a, SheetHit b, double row) {
  // the rounding of a pixel coordinate of a thousand, through ray, hit and projection
  constexpr double rounding_px = 1e-11;
  double a_px = a.pixel.y() - row, b_px = b.pixel.y() - row;
  if (std::abs(a_px) < rounding_px) return a;
  if (std::abs(b_px) < rounding_px) return b;
  int kept_before = 0;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double angle_rad = (a_px * b.angle_rad - b_px * a.angle_rad) / (a_px - b_px);
    const SheetHit middle = view.shine(angle_rad, 0);
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

bool is_seen(const LaserView& view, const SheetHit& point) {
  const Camera& camera = view.scanner.camera;
  if (!(point.pixel.x() >= -0.5 && point.pixel.x() <= camera.width_px - 0.5)) return false;
  // far outside a distorted image the projection folds back into it
  const auto ray = ray_through(camera, point.pixel);
  if (!ray || (*ray - point.x_in_camera / point.x_in_camera.z()).norm() > 1e-9) return false;
  return !view.caster.occluded(point.hit, view.world_from_camera.translation());
}

// One step's rays while the fan is followed.
struct StepTruth {
  const LaserView& view;
  Pose scanner_from_camera;
  std::span<RayTruth> rays;  // one per row
  std::vector<double> nearest_m =
      std::vector<double>(rays.size(), std::numeric_limits<double>::infinity());

  void take(int row, const SheetHit& point) {
    const double distance_m = point.x_in_camera.norm();
    if (distance_m >= nearest_m[row] || !is_seen(view, point)) return;
    nearest_m[row] = distance_m;
    const Eigen::Matrix3d scanner_from_world =
        scanner_from_camera.linear() * view.world_from_camera.linear().transpose();
    rays[row] = {scanner_from_camera * point.x_in_camera, scanner_from_world * point.hit.normal,
                 point.hit.object};
  }

  // All rows between two fan rays. Where their points are far apart the rays between them follow,
  // so that a surface is kept up to the limb where the light leaves it.
  void follow(const SheetHit& a, const SheetHit& b, int depth) {
    if (!a.is_hit && !b.is_hit) return;
    const bool near = a.is_hit && b.is_hit && (a.pixel - b.pixel).norm() < 2;
    if (!near && depth > 0) {
      const SheetHit middle = view.shine((a.angle_rad + b.angle_rad) / 2, 0);
      follow(a, middle, depth - 1);
      follow(middle, b, depth - 1);
      return;
    }
    if (!a.is_hit || !b.is_hit) return;
    const auto [low, high] = std::minmax(a.pixel.y(), b.pixel.y());
    for (int row = static_cast<int>(std::max(0.0, std::ceil(low)));
         row < static_cast<int>(rays.size()) && row <= high; ++row)
      if (const auto point = on_row(view, a, b, row)) take(row, *point);
  }
};

void follow_fan(StepTruth& truth) {
  const double half_rad = truth.view.sheet.half_fan_rad;
  const int steps = fan_steps(truth.view.scanner, 0.5);
  SheetHit previous = truth.view.shine(-half_rad, 0);
  for (int i = 1; i <= steps; ++i) {
    const SheetHit next = truth.view.shine(half_rad * (2.0 * i / steps - 1), 0);
    truth.follow(previous, next, 20);
    previous = next;
  }
}

}  // namespace

std::vector<RayTruth> true_rays(const LaserLine& device, const RayCaster& caster,
                                const Pose& world_from_scanner) {
  check(device);
  const LaserLine scanner = with_effects(device, {});
  const LaserSheet sheet = laser_sheet(scanner);
  const std::vector<Pose> poses = scanner_from_camera(scanner);
  std::vector<RayTruth> rays(poses.size() * scanner.camera.height_px);
  parallel_for(
      poses.size(),
      [&](std::size_t step) {
        const LaserView view{scanner, sheet, caster, world_from_scanner * poses[step]};
        const auto rows = static_cast<std::size_t>(scanner.camera.height_px);
        StepTruth truth{view, poses[step], std::span(rays).subspan(step * rows, rows)};
        follow_fan(truth);
      },
      1);
  return rays;
}

}  // namespace scan::synth
