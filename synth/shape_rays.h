// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where a ray meets an analytic shape, in double precision.
#pragma once

#include <limits>
#include <optional>

#include "libscan/core/shape.h"

namespace scan::synth {

// x(t) = origin + t direction with a unit direction; hits count for t in the open interval.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double min_m = 0;
  double max_m = std::numeric_limits<double>::infinity();
};

struct ShapeHit {
  double distance_m = 0;
  Eigen::Vector3d normal;  // unit, out of the solid
};

// First crossing of the shape's surface, from outside or from inside. Plane, sphere, cylinder and
// box without rounding by closed form, the others by stepping along the distance field (Hart 1996,
// "Sphere tracing") and refining the bracketed root to rounding. A crossing nearer to the origin
// than the rounding of its coordinates is the surface that the ray starts on, and no hit.
std::optional<ShapeHit> intersect(const Shape& shape, const Ray& ray);
std::optional<ShapeHit> intersect(const PlacedShape& placed, const Ray& ray);

// First change of sign of the field inside the ray's interval; `bounds` encloses the solid. Public
// so that tests can hold the closed forms against it.
std::optional<ShapeHit> trace_field(const Shape& shape, const Bounds& bounds, const Ray& ray);

// The part [enter, leave] of the line inside the box; none if they do not meet.
struct Interval {
  double enter_m;
  double leave_m;
};
std::optional<Interval> clip(const Bounds& bounds, const Ray& ray);

}  // namespace scan::synth
