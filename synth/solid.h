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

// The scene frame is the world's, moved to `scene_origin`, which keeps coordinates small.
struct Solid {
  int object = 0;
  double size_m = 0;  // diagonal of its bounds; 0 if they are infinite
  Bounds bounds;
  bool is_mesh = false;
  PlacedShape shape;  // of no mesh
  std::vector<Eigen::Vector3d> vertices;
  // Turned so that the first corner faces the longest edge, where the normal is most accurate.
  std::vector<Triangle> triangles;
};

// Middle of all finite objects; without one, the first object's origin.
Eigen::Vector3d scene_origin(const Scene& scene);

Solid make_solid(const Scene& scene, int object, const Eigen::Vector3d& origin);

bool is_finite(const Bounds& box);

// True if the triangle's height exceeds the rounding of its coordinates; others are never hit.
bool has_area(const Solid& solid, const Triangle& corners);

// Unit, by the order of the corners.
Eigen::Vector3d normal_of(const Solid& solid, const Triangle& corners);

// Distances from an origin at `from_m` to things of `size_m` that differ by less are equal; nearer
// hits are on the surface that the ray starts on.
inline double rounding_m(double from_m, double size_m) {
  return 64 * std::numeric_limits<double>::epsilon() * (from_m + size_m);
}

}  // namespace scan::synth
