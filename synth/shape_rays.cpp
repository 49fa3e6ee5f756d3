// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/shape_rays.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Entry into a convex solid and exit from it, with the outward normals there.
struct Chord {
  double enter_m = -infinity;
  double leave_m = infinity;
  Eigen::Vector3d enter_normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d leave_normal = Eigen::Vector3d::Zero();
};

// What is left of the chord between the planes n.x = -half and n.x = +half, n a coordinate axis.
bool cut_by_slab(const Ray& ray, Eigen::Index axis, double half_m, Chord& chord) {
  const double o = ray.origin(axis), d = ray.direction(axis);
  if (d == 0) return std::abs(o) <= half_m;
  const double side = d > 0 ? 1 : -1;
  const double enter = (-side * half_m - o) / d, leave = (side * half_m - o) / d;
  if (enter > chord.enter_m) {
    chord.enter_m = enter;
    chord.enter_normal = -side * Eigen::Vector3d::Unit(axis);
  }
  if (leave < chord.leave_m) {
    chord.leave_m = leave;
    chord.leave_normal = side * Eigen::Vector3d::Unit(axis);
  }
  return chord.enter_m <= chord.leave_m;
}

// Roots of |o + t d|^2 = r^2 in `Dim` dimensions by the foot of the perpendicular from the centre,
// which keeps its accuracy for small spheres far away (Haines, Gunther, Akenine-Moller 2019,
// "Precision improvements for ray/sphere intersection").
template <int Dim>
std::optional<Interval> circle_chord(const Eigen::Matrix<double, Dim, 1>& o,
                                     const Eigen::Matrix<double, Dim, 1>& d, double radius_m) {
  const double d2 = d.squaredNorm();
  const double foot = -o.dot(d) / d2;
  const double gap = (o + foot * d).norm();
  if (!(gap <= radius_m)) return std::nullopt;
  const double half = std::sqrt((radius_m - gap) * (radius_m + gap) / d2);
  // far root without cancellation, near root by Vieta's product of the roots
  const double far = foot + (foot < 0 ? -half : half);
  const double length = o.norm();
  const double product = (length - radius_m) * (length + radius_m) / d2;
  const double near = far != 0 ? product / far : 0;
  return Interval{std::min(near, far), std::max(near, far)};
}

// The chord's first end inside the ray's interval and beyond the surface that the ray starts on.
std::optional<ShapeHit> first_end(const Chord& chord, const Ray& ray, double size_m) {
  const double nearest = std::max(ray.min_m, 64 * epsilon * (ray.origin.norm() + size_m));
  if (chord.enter_m > nearest) {
    if (!(chord.enter_m < ray.max_m)) return std::nullopt;
    return ShapeHit{chord.enter_m, chord.enter_normal};
  }
  if (chord.leave_m > nearest && chord.leave_m < ray.max_m)
    return ShapeHit{chord.leave_m, chord.leave_normal};
  return std::nullopt;
}

std::optional<ShapeHit> first_hit(const PlaneShape&, const Ray& ray) {
  const double t = -ray.origin.z() / ray.direction.z();
  const double nearest = std::max(ray.min_m, 64 * epsilon * ray.origin.norm());
  if (!(t > nearest && t < ray.max_m)) return std::nullopt;
  return ShapeHit{t, Eigen::Vector3d::UnitZ()};
}

std::optional<ShapeHit> first_hit(const SphereShape& sphere, const Ray& ray) {
  const auto roots = circle_chord<3>(ray.origin, ray.direction, sphere.radius_m);
  if (!roots) return std::nullopt;
  const Chord chord{roots->enter_m, roots->leave_m};
  auto hit = first_end(chord, ray, sphere.radius_m);
  if (hit) hit->normal = (ray.origin + hit->distance_m * ray.direction).normalized();
  return hit;
}

std::optional<ShapeHit> first_hit(const CylinderShape& cylinder, const Ray& ray) {
  Chord chord;
  const Eigen::Vector2d o = ray.origin.head<2>(), d = ray.direction.head<2>();
  if (d.squaredNorm() > 0) {
    const auto roots = circle_chord<2>(o, d, cylinder.radius_m);
    if (!roots) return std::nullopt;
    const auto radial = [&](double t) {
      const Eigen::Vector2d n = (o + t * d).normalized();
      return Eigen::Vector3d(n.x(), n.y(), 0);
    };
    chord = {roots->enter_m, roots->leave_m, radial(roots->enter_m), radial(roots->leave_m)};
  } else if (o.norm() > cylinder.radius_m) {
    return std::nullopt;
  }
  if (!cut_by_slab(ray, 2, cylinder.height_m / 2, chord)) return std::nullopt;
  return first_end(chord, ray, std::hypot(cylinder.radius_m, cylinder.height_m / 2));
}

std::optional<ShapeHit> first_hit(const BoxShape& box, const Ray& ray) {
  if (box.rounding_m > 0) return trace_field(box, Bounds(-box.size_m / 2, box.size_m / 2), ray);
  Chord chord;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (!cut_by_slab(ray, axis, box.size_m(axis) / 2, chord)) return std::nullopt;
  return first_end(chord, ray, box.size_m.norm() / 2);
}

template <class Traced>
std::optional<ShapeHit> first_hit(const Traced& shape, const Ray& ray) {
  return trace_field(shape, bounds_of(PlacedShape{Pose::Identity(), shape}), ray);
}

}  // namespace

std::optional<Interval> clip(const Bounds& bounds, const Ray& ray) {
  Interval inside{ray.min_m, ray.max_m};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double o = ray.origin(axis), d = ray.direction(axis);
    if (d == 0) {
      if (o < bounds.min()(axis) || o > bounds.max()(axis)) return std::nullopt;
      continue;
    }
    const double a = (bounds.min()(axis) - o) / d, b = (bounds.max()(axis) - o) / d;
    inside = {std::max(inside.enter_m, std::min(a, b)), std::min(inside.leave_m, std::max(a, b))};
  }
  if (!(inside.enter_m <= inside.leave_m)) return std::nullopt;
  return inside;
}

std::optional<ShapeHit> intersect(const Shape& shape, const Ray& ray) {
  return std::visit([&](const auto& s) { return first_hit(s, ray); }, shape);
}

std::optional<ShapeHit> intersect(const PlacedShape& placed, const Ray& ray) {
  const Eigen::Matrix3d rotation = placed.parent_from_shape.linear();
  const Ray local{rotation.transpose() * (ray.origin - placed.parent_from_shape.translation()),
                  rotation.transpose() * ray.direction, ray.min_m, ray.max_m};
  auto hit = intersect(placed.shape, local);
  if (hit) hit->normal = rotation * hit->normal;
  return hit;
}

}  // namespace scan::synth
