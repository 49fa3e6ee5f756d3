// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/solid.h"

#include <algorithm>

#include "libscan/core/parallel.h"

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

// The same triangle, its first corner opposite to its longest edge.
Triangle turned(const std::vector<Eigen::Vector3d>& vertices, Triangle t) {
  double longest_m2 = -1;
  int first = 0;
  for (int i = 0; i < 3; ++i) {
    const double edge_m2 = (vertices[t[(i + 1) % 3]] - vertices[t[(i + 2) % 3]]).squaredNorm();
    if (edge_m2 > longest_m2) first = i;
    longest_m2 = std::max(longest_m2, edge_m2);
  }
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

void take_mesh(const Mesh& mesh, const Pose& scene_from_object, Solid& solid) {
  solid.is_mesh = true;
  solid.vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices) {
    solid.vertices.push_back(scene_from_object * v);
    solid.bounds.extend(solid.vertices.back());
  }
  solid.triangles.resize(mesh.triangles.size());
  parallel_for(
      mesh.triangles.size(),
      [&](std::size_t i) { solid.triangles[i] = turned(solid.vertices, mesh.triangles[i]); }, 4096);
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

bool has_area(const Solid& solid, const Triangle& corners) {
  const auto [i, j, k] = corners;
  const Eigen::Vector3d &a = solid.vertices[i], &b = solid.vertices[j], &c = solid.vertices[k];
  const double coordinate = std::max({a.norm(), b.norm(), c.norm()});
  return (b - a).cross(c - a).norm() > 4 * epsilon * coordinate * (c - b).norm();
}

Eigen::Vector3d normal_of(const Solid& solid, const Triangle& corners) {
  const auto [i, j, k] = corners;
  const Eigen::Vector3d& a = solid.vertices[i];
  return (solid.vertices[j] - a).cross(solid.vertices[k] - a).normalized();
}

}  // namespace scan::synth
