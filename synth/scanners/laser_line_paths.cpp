// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan::synth {

using std::numbers::pi;

SheetEmitter::SheetEmitter(const LaserView& view)
    : view_(view), position_(view.world_from_camera * view.sheet.origin) {
  // Irradiance times r, over the fan's angle and across the plane: the Gaussian's integral is w
  // sqrt(pi / 2), and w cancels.
  const LaserSheet& sheet = view.sheet;
  flux_ = view.scanner.peak_electrons / std::cos(view.scanner.triangulation_rad) * sheet.focus_m *
          sheet.waist_m * std::sqrt(pi / 2) * 2 * sheet.half_fan_rad;
}

double SheetEmitter::irradiance(const Eigen::Vector3d& direction, double length_m) const {
  const Eigen::Vector3d in_camera = view_.world_from_camera.linear().transpose() * direction;
  return sheet_light(view_.scanner, view_.sheet, view_.sheet.origin + length_m * in_camera)
      .irradiance_e;
}

EmittedRay SheetEmitter::sample(const Eigen::Vector2d& u) const {
  const LaserSheet& sheet = view_.sheet;
  const double angle_rad = sheet.half_fan_rad * (2 * u.x() - 1);
  // two normal numbers (Box and Muller 1958): the digits of u.y after the twelfth are one more
  const double turn_rad = 2 * pi * (u.y() * 4096 - std::floor(u.y() * 4096));
  const double radius_m = sheet.waist_m / 2 * std::sqrt(-2 * std::log1p(-u.y()));
  const double place_m = radius_m * std::cos(turn_rad);
  const double slope = radius_m * std::sin(turn_rad) / sheet.rayleigh_m;
  const Eigen::Vector3d origin = sheet.origin + (place_m - slope * sheet.focus_m) * sheet.normal;
  const Eigen::Vector3d direction =
      (fan_direction(sheet, angle_rad) + slope * sheet.normal).normalized();
  return {view_.world_from_camera * origin, view_.world_from_camera.linear() * direction, flux_};
}

// exp(-2 d^2 / w^2) is a half at d = w sqrt(ln 2 / 2). A ray along the plane is bright for as far
// as the laser is away.
Brightest SheetEmitter::brightest(const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) const {
  const LaserSheet& sheet = view_.sheet;
  const Eigen::Vector3d normal = view_.world_from_camera.linear() * sheet.normal;
  const double away_m = normal.dot(origin - position_), slope = normal.dot(direction);
  const double far_m = (origin - position_).norm() + sheet.focus_m;
  const double distance_m = std::clamp(-away_m / slope, -far_m, far_m);
  const double radius_m = sheet.radius_m((origin + distance_m * direction - position_).norm());
  const double half_m = radius_m * std::sqrt(std::numbers::ln2 / 2);
  return {.distance_m = std::isfinite(distance_m) ? distance_m : 0,
          .half_width_m = std::isfinite(distance_m)
                              ? std::min(half_m / std::max(std::abs(slope), 1e-9), far_m)
                              : far_m};
}

// No farther from the plane than the beam and its bow.
bool SheetEmitter::reaches(const Eigen::Vector3d& centre, double radius_m) const {
  const LaserSheet& sheet = view_.sheet;
  const Eigen::Vector3d away = view_.world_from_camera.linear().transpose() * (centre - position_);
  const double far_m = away.norm() + radius_m;
  const double half_m = std::max(sheet.radius_m(far_m), sheet.radius_m(0)) * sheet.reach_radii;
  return std::abs(sheet.normal.dot(away)) <= radius_m + half_m + std::abs(sheet.bow_slope) * far_m;
}

void PathSums::device_light(double electrons, double path_m, int scatterings) {
  // the straight way is the shortest but for rounding
  if (scatterings <= 1 && path_m <= direct_way_m * (1 + 1e-9)) {
    direct_e += electrons;
    return;
  }
  indirect_e += electrons;
  indirect_way_e += electrons * path_m;
}

double straight_way_m(const LaserView& view, const CameraRay& ray) {
  const auto seen = view.caster.closest(view.world_from_camera * ray.origin,
                                        view.world_from_camera.linear() * ray.direction);
  if (!seen) return 0;
  const Eigen::Vector3d x = ray.origin + seen->distance_m * ray.direction;
  return seen->distance_m + (x - view.sheet.origin).norm();
}

bool needs_paths(const LaserLine& scanner, const Scene& scene, const EffectSet& effects) {
  if (effects.has(Effect::interreflection)) return true;
  if (effects.has(Effect::medium) && scene.medium) return true;
  if (scanner.electrons_per_w_m2 > 0 && !scene.lights.empty()) return true;
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    const Material& material = scene.materials[object.material];
    return (effects.has(Effect::mirror_reflection) && has_delta(material.bsdf)) ||
           ((effects.has(Effect::refraction) || effects.has(Effect::subsurface)) &&
            is_transmissive(material.bsdf));
  });
}

LaserPaths::LaserPaths(const RayCaster& caster, const EffectSet& effects)
    : transport(caster, transport_options(effects, true)),
      direct_is_straight(!caster.scene().medium),
      everywhere(effects.everywhere()) {
  for (const ObjectOptics& optics : optics_of(caster.scene()))
    if (optics.is_transmissive) direct_is_straight = false;
}

PixelLight trace_light(const LaserPaths& paths, const LaserView& view, const SheetEmitter& emitter,
                       const CameraRay& ray, SampleSequence& random) {
  PathSums sums{.direct_way_m = straight_way_m(view, ray)};
  const Ray backwards{.origin = view.world_from_camera * ray.origin,
                      .direction = view.world_from_camera.linear() * ray.direction};
  trace_path(paths.transport, backwards, emitter, random, sums);
  PixelLight light{.laser_e = sums.indirect_e,
                   .other_e = sums.other_w_m2 * view.scanner.electrons_per_w_m2};
  if (paths.direct_is_straight) return light;
  light.laser_e += sums.direct_e;
  light.other_e += sums.ambient_share * view.scanner.ambient_electrons;
  return light;
}

}  // namespace scan::synth
