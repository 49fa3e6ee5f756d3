// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_optics.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {

LaserSheet laser_sheet(const LaserLine& scanner) {
  const double s = std::sin(scanner.triangulation_rad), c = std::cos(scanner.triangulation_rad);
  // exp(-2 d^2 / w^2) brings even a steeper and nearer surface than the focus (10 times) below 1e-4
  // e
  const double decades = std::log(std::max(10 * scanner.peak_electrons / 1e-4, 10.0));
  return {.origin = {scanner.baseline_m, 0, 0},
          .normal = {c, 0, s},
          .offset_m = scanner.baseline_m * c,
          .middle = {-s, 0, c},
          .half_fan_rad = scanner.fan_rad / 2,
          .reach_m = scanner.beam_radius_m * std::sqrt(decades / 2)};
}

Eigen::Vector3d fan_direction(const LaserSheet& sheet, double angle_rad) {
  return std::cos(angle_rad) * sheet.middle + std::sin(angle_rad) * Eigen::Vector3d::UnitY();
}

std::vector<Pose> scanner_from_camera(const LaserLine& scanner) {
  std::vector<Pose> poses;
  for (int step = 0; step < scanner.steps; ++step) {
    const double from_middle = step - (scanner.steps - 1) / 2.0;
    if (scanner.turn_rad == 0) {
      poses.push_back(
          make_pose(Eigen::Matrix3d::Identity(),
                    from_middle * scanner.step_m * scanner.stage_direction.normalized()));
      continue;
    }
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(from_middle * scanner.turn_rad, scanner.turn_axis.normalized())
            .toRotationMatrix();
    poses.push_back(make_pose(rotation, scanner.turn_centre_m - rotation * scanner.turn_centre_m));
  }
  return poses;
}

int fan_steps(const LaserLine& scanner, double step_px) {
  // a point at distance r from the laser is about r cos(triangulation) deep
  const double step_rad = step_px * std::cos(scanner.triangulation_rad) /
                          std::max(scanner.camera.fx_px, scanner.camera.fy_px);
  return std::max(2, static_cast<int>(std::ceil(scanner.fan_rad / step_rad)));
}

LitPoint LaserView::shine(double angle_rad, double from_plane_m) const {
  LitPoint point{.angle_rad = angle_rad, .from_plane_m = from_plane_m};
  const Eigen::Vector3d origin = sheet.origin + from_plane_m * sheet.normal;
  const Eigen::Vector3d direction = fan_direction(sheet, angle_rad);
  const Eigen::Vector3d direction_in_world = world_from_camera.linear() * direction;
  const auto hit = caster.closest(world_from_camera * origin, direction_in_world);
  if (!hit) return point;
  point.x_in_camera = origin + hit->distance_m * direction;
  const auto pixel = project(scanner.camera, point.x_in_camera);
  if (!pixel) return point;
  point.pixel = *pixel;
  point.hit = facing(*hit, direction_in_world);
  point.is_hit = true;
  return point;
}

double LaserView::electrons(const Eigen::Vector3d& ray_in_camera) const {
  const Eigen::Vector3d direction = ray_in_camera.normalized();
  const Eigen::Vector3d direction_in_world = world_from_camera.linear() * direction;
  const auto seen = caster.closest(world_from_camera.translation(), direction_in_world);
  if (!seen) return 0;
  const Eigen::Vector3d x = seen->distance_m * direction;
  const double from_plane_m = sheet.normal.dot(x) - sheet.offset_m;
  if (std::abs(from_plane_m) > sheet.reach_m) return 0;
  const Eigen::Vector3d source = sheet.origin + from_plane_m * sheet.normal;
  const Eigen::Vector3d path = x - source;
  const double length_m = path.norm();
  if (std::abs(std::atan2(path.y(), path.dot(sheet.middle))) > sheet.half_fan_rad) return 0;
  const Hit hit = facing(*seen, direction_in_world);
  if (caster.occluded(hit, world_from_camera * source)) return 0;
  // Irradiance of a sheet that spreads in one direction falls with 1/r; at the focus, r = b / sin,
  // a target that faces the camera is met at the triangulation angle.
  const double focus_m = scanner.baseline_m / std::sin(scanner.triangulation_rad);
  const double cosine = -hit.normal.dot(world_from_camera.linear() * path) / length_m;
  const double w = scanner.beam_radius_m;
  return scanner.peak_electrons * albedo_at(caster.scene(), hit.object, hit.point) *
         (focus_m / length_m) * std::exp(-2 * from_plane_m * from_plane_m / (w * w)) * cosine /
         std::cos(scanner.triangulation_rad);
}

}  // namespace scan::synth
