// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_optics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/frame_about.h"

namespace scan::synth {
namespace {

// How a surface reflects, in a frame whose z is the hit's normal.
struct Reflector {
  Bsdf bsdf;
  Eigen::Matrix3d local_from_world;
  Eigen::Vector3d out;

  Reflector(const Scene& scene, const Hit& hit, const Eigen::Vector3d& out_in_world)
      : bsdf(bsdf_at(scene, hit.object, hit.triangle, hit.point)) {
    local_from_world = frame_about(hit.normal).transpose();
    out = local_from_world * out_in_world;
  }
  // Electrons by an irradiance (facing the light) of so many electrons on white Lambert: pi f cos.
  double electrons(double irradiance_e, const Eigen::Vector3d& in_in_world) const {
    const Eigen::Vector3d in = local_from_world * in_in_world;
    return irradiance_e * std::numbers::pi * evaluate(bsdf, out, in) * in.z();
  }
};

}  // namespace

LaserLine with_effects(const LaserLine& device, const EffectSet& effects) {
  LaserLine s = device;
  if (!effects.has(Effect::footprint)) s.sub_rays = 1;
  if (!effects.has(Effect::beam_spread)) s.beam_quality = 0;
  if (!effects.has(Effect::plane_bow)) s.plane_bow_m = 0;
  if (!effects.has(Effect::miscalibration)) s.plane_shift_m = s.plane_turn_rad = 0;
  if (!effects.has(Effect::defocus)) s.aperture_m = 0;
  if (!effects.has(Effect::speckle)) s.speckle_contrast = 0;
  if (!effects.has(Effect::motion)) s.exposure_share = 0;
  if (!effects.has(Effect::blooming)) s.blooming_share = 0;
  if (!effects.has(Effect::scene_lights)) s.ambient_electrons = s.electrons_per_w_m2 = 0;
  return s;
}

double LaserSheet::radius_m(double from_laser_m) const {
  const double u = (from_laser_m - focus_m) / rayleigh_m;
  return waist_m * std::sqrt(1 + u * u);
}

double LaserSheet::slope_at(double angle_rad) const {
  const double share = angle_rad / half_fan_rad;
  return bow_slope * share * share;
}

LaserSheet laser_sheet(const LaserLine& scanner) {
  const double angle_rad = scanner.triangulation_rad + scanner.plane_turn_rad;
  const double s = std::sin(angle_rad), c = std::cos(angle_rad);
  // exp(-2 d^2 / w^2) brings even a steeper and nearer surface than the focus (10 times) below 1e-4
  // e
  const double decades = std::log(std::max(10 * scanner.peak_electrons / 1e-4, 10.0));
  const double focus_m = scanner.baseline_m / std::sin(scanner.triangulation_rad);
  const double w = scanner.beam_radius_m;
  LaserSheet sheet{
      .origin = {scanner.baseline_m, 0, 0},
      .normal = {c, 0, s},
      .offset_m = 0,
      .middle = {-s, 0, c},
      .half_fan_rad = scanner.fan_rad / 2,
      .focus_m = focus_m,
      .waist_m = w,
      .rayleigh_m = std::numbers::pi * w * w / (scanner.beam_quality * scanner.wavelength_m),
      .bow_slope = scanner.plane_bow_m / focus_m,
      .reach_radii = std::sqrt(decades / 2)};
  sheet.origin += scanner.plane_shift_m * sheet.normal;
  sheet.offset_m = scanner.baseline_m * c + scanner.plane_shift_m;
  return sheet;
}

Eigen::Vector3d fan_direction(const LaserSheet& sheet, double angle_rad) {
  return (std::cos(angle_rad) * sheet.middle + std::sin(angle_rad) * Eigen::Vector3d::UnitY() +
          sheet.slope_at(angle_rad) * sheet.normal)
      .normalized();
}

Pose stage_pose(const LaserLine& scanner, double steps) {
  if (scanner.turn_rad == 0)
    return make_pose(Eigen::Matrix3d::Identity(),
                     steps * scanner.step_m * scanner.stage_direction.normalized());
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(steps * scanner.turn_rad, scanner.turn_axis.normalized())
          .toRotationMatrix();
  return make_pose(rotation, scanner.turn_centre_m - rotation * scanner.turn_centre_m);
}

std::vector<Pose> scanner_from_camera(const LaserLine& scanner) {
  std::vector<Pose> poses;
  for (int step = 0; step < scanner.steps; ++step)
    poses.push_back(stage_pose(scanner, step - (scanner.steps - 1) / 2.0));
  return poses;
}

int fan_steps(const LaserLine& scanner, double step_px) {
  // a point at distance r from the laser is about r cos(triangulation) deep
  const double step_rad = step_px * std::cos(scanner.triangulation_rad) /
                          std::max(scanner.camera.fx_px, scanner.camera.fy_px);
  return std::max(2, static_cast<int>(std::ceil(scanner.fan_rad / step_rad)));
}

LaserView LaserView::after(double time_steps) const {
  return {scanner, sheet, caster, world_from_camera * stage_pose(scanner, time_steps)};
}

SheetHit LaserView::shine(double angle_rad, double from_plane_m) const {
  SheetHit point{.angle_rad = angle_rad, .from_plane_m = from_plane_m};
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
  // a ray at the very reach counts, in spite of rounding
  const double reach_m = sheet.reach_radii * sheet.radius_m(hit->distance_m);
  point.is_lit = std::abs(from_plane_m) <= reach_m * (1 + 1e-9);
  return point;
}

SheetLight sheet_light(const LaserLine& scanner, const LaserSheet& sheet,
                       const Eigen::Vector3d& x) {
  const double across_m = sheet.normal.dot(x) - sheet.offset_m;
  const Eigen::Vector3d along = x - sheet.origin - across_m * sheet.normal;
  const double length_m = along.norm();
  const double angle_rad = std::atan2(along.y(), along.dot(sheet.middle));
  const double from_plane_m = across_m - sheet.slope_at(angle_rad) * length_m;
  const double radius_m = sheet.radius_m(length_m);
  if (std::abs(from_plane_m) > sheet.reach_radii * radius_m) return {};
  if (std::abs(angle_rad) > sheet.half_fan_rad) return {};
  // Irradiance of a sheet that spreads in one direction falls with 1/r, and with its thickness; at
  // the focus a target that faces the camera is met at the triangulation angle.
  const double u = from_plane_m / radius_m;
  return {scanner.peak_electrons / std::cos(scanner.triangulation_rad) *
              (sheet.focus_m / length_m) * (sheet.waist_m / radius_m) * std::exp(-2 * u * u),
          sheet.origin + from_plane_m * sheet.normal};
}

PixelLight LaserView::light(const CameraRay& ray) const {
  const Eigen::Vector3d direction_in_world = world_from_camera.linear() * ray.direction;
  const auto seen = caster.closest(world_from_camera * ray.origin, direction_in_world);
  if (!seen) return {};
  const Hit hit = facing(*seen, direction_in_world);
  const Reflector reflector(caster.scene(), hit, -direction_in_world);
  PixelLight light;
  // light from everywhere: what leaves over what comes, by reciprocity that of the view's direction
  if (scanner.ambient_electrons > 0)
    light.other_e = scanner.ambient_electrons * albedo(reflector.bsdf, reflector.out);
  const Eigen::Vector3d x = ray.origin + seen->distance_m * ray.direction;
  const SheetLight from_sheet = sheet_light(scanner, sheet, x);
  if (from_sheet.irradiance_e == 0) return light;
  if (caster.occluded(hit, world_from_camera * from_sheet.source)) return light;
  const Eigen::Vector3d in = world_from_camera.linear() * (from_sheet.source - x).normalized();
  light.laser_e = reflector.electrons(from_sheet.irradiance_e, in);
  return light;
}

}  // namespace scan::synth
