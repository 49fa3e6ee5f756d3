// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/first_surface.h"

namespace scan::synth {

std::optional<SeenSurface> first_surface(const RayCaster& caster, const Pose& world_from_scanner,
                                         const ScannerRay& ray) {
  const Eigen::Vector3d direction_in_world = world_from_scanner.linear() * ray.direction;
  const auto found = caster.closest(world_from_scanner * ray.origin, direction_in_world);
  if (!found) return std::nullopt;
  const Hit hit = facing(*found, direction_in_world);
  return SeenSurface{.point = ray.origin + hit.distance_m * ray.direction,
                     .normal = world_from_scanner.linear().transpose() * hit.normal,
                     .hit = hit};
}

RayTruth true_ray(const RayCaster& caster, const Pose& world_from_scanner, const ScannerRay& ray) {
  const auto seen = first_surface(caster, world_from_scanner, ray);
  if (!seen) return {};
  return {.point_in_scanner = seen->point,
          .normal_in_scanner = seen->normal,
          .object = seen->hit.object};
}

}  // namespace scan::synth
