// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/solid.h"

#include <algorithm>

namespace scan::synth {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Bounds world_bounds(const Object& object) {
  if (const auto* shape = std::get_if<Shape>(&object.geometry))
    return bounds_of(PlacedShape{object.world_from_object, *shape});
  Bounds box;
  for (const Eigen::Vector3d& v : std::get<Mesh>(object.geometry).vertices)
    box.extend(object.world_from_object * v);
  return box;
}

bool has_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  const double coordinate = std::max({a.norm(), b.norm(), c.norm()});
  return (b - a).cross(c - a).norm() > 4 * epsilon * coordinate * longest;
}

void take_mesh(const Mesh& mesh, const Pose& scene_from_object, Solid& solid) {
  solid.triangles = mesh.triangles;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    solid.vertices.push_back(scene_from_object * v);
    solid.bounds.extend(solid.vertices.back());
  }
  for (const Triangle& t : mesh.triangles)
    solid.has_area.push_back(
        has_area(solid.vertices[t[0]], solid.vertices[t[1]], solid.vertices[t[2]]));
}

}  // namespace

bool is_finite(const Bounds& box) {
  return box.min().allFinite() && box.max().allFinite();
}

Eigen::Vector3d scene_origin(const Scene& scene) {
  Bounds all;
  for (const Object& object : scene.objects)
    if (const Bounds box = world_bounds(object); !box.isEmpty() && is_finite(box)) all.extend(box);
  if (!all.isEmpty()) return all.center();
  if (scene.objects.empty()) return Eigen::Vector3d::Zero();
  return scene.objects.front().world_from_object.translation();
}

Solid make_solid(const Scene& scene, int index, const Eigen::Vector3d& origin) {
  const Object& object = scene.objects[index];
  Solid solid;
  solid.object = index;
  Pose scene_from_object = object.world_from_object;
  scene_from_object.translation() -= origin;
  if (const auto* shape = std::get_if<Shape>(&object.geometry)) {
    solid.shape = {scene_from_object, *shape};
    solid.bounds = bounds_of(solid.shape);
  } else {
    take_mesh(std::get<Mesh>(object.geometry), scene_from_object, solid);
  }
  if (!solid.bounds.isEmpty() && is_finite(solid.bounds))
    solid.size_m = solid.bounds.diagonal().norm();
  return solid;
}

double rounding_m(const Solid& solid, const Ray& ray, double distance_m) {
  return 64 * epsilon * (ray.origin.norm() + distance_m + solid.size_m);
}

std::optional<SolidHit> meet(const Solid& solid, std::uint32_t triangle, const Ray& ray,
                             const ShearedRay& sheared_ray) {
  if (solid.triangles.empty()) {
    const auto hit = intersect(solid.shape, ray);
    if (!hit) return std::nullopt;
    return SolidHit{hit->distance_m, hit->normal, solid.object, 0};
  }
  if (!solid.has_area[triangle]) return std::nullopt;
  const auto [i, j, k] = solid.triangles[triangle];
  const Eigen::Vector3d &a = solid.vertices[i], &b = solid.vertices[j], &c = solid.vertices[k];
  const auto distance = line_distance(sheared_ray, a, b, c);
  const double nearest = std::max(ray.min_m, rounding_m(solid, ray, 0));
  if (!distance || !(*distance > nearest && *distance < ray.max_m)) return std::nullopt;
  return SolidHit{*distance, (b - a).cross(c - a), solid.object, triangle};
}

}  // namespace scan::synth
