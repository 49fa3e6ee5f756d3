// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/effects/convex.h"

namespace scan::synth {
namespace {

bool is_convex(const Shape& shape) {
  return std::holds_alternative<PlaneShape>(shape) || std::holds_alternative<SphereShape>(shape) ||
         std::holds_alternative<CylinderShape>(shape) || std::holds_alternative<BoxShape>(shape);
}

}  // namespace

bool light_meets_once(const Scene& scene, const Eigen::Vector3d& device) {
  if (scene.objects.size() != 1 || scene.medium || !scene.lights.empty()) return false;
  const Object& object = scene.objects[0];
  const auto* shape = std::get_if<Shape>(&object.geometry);
  return shape && is_convex(*shape) &&
         field(*shape, object.world_from_object.inverse() * device).value_m > 0 &&
         !is_transmissive(scene.materials[object.material].bsdf);
}

}  // namespace scan::synth
