// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// An object of a scene as rays see it: in the scene's own frame, ready for intersection in double.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "synth/scene.h"
#include "synth/shape_rays.h"
#include "synth/triangle.h"

namespace scan::synth {

// Where a ray meets an object; the normal points outwards and need not have length 1.
struct SolidHit {
  double distance_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  int object = -1;
  std::uint32_t triangle = 0;
};

// The scene frame is the world's, moved to `scene_origin`, which keeps coordinates small.
struct Solid {
  int object = 0;
  double size_m = 0;    // diagonal of its bounds; 0 if they are infinite
  double margin_m = 0;  // that a search structure in floats must add to its boxes
  Bounds bounds;
  PlacedShape shape;  // used if there are no triangles
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  std::vector<char> has_area;  // per triangle: its height exceeds the rounding of its coordinates
};

// Middle of all finite objects; without one, the first object's origin.
Eigen::Vector3d scene_origin(const Scene& scene);

Solid make_solid(const Scene& scene, int object, const Eigen::Vector3d& origin);

bool is_finite(const Bounds& box);

// The triangle, or the whole shape, met by a ray of the scene frame; `sheared_ray` is the same ray.
std::optional<SolidHit> meet(const Solid& solid, std::uint32_t triangle, const Ray& ray,
                             const ShearedRay& sheared_ray);

// Distances that differ by less are equal.
double rounding_m(const Solid& solid, const Ray& ray, double distance_m);

}  // namespace scan::synth
