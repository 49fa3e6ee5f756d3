// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // clang 14 does not deduce aggregates

void check_positive(const char* shape, const char* name, double value) {
  if (std::isfinite(value) && value > 0) return;
  throw Error(Trouble::input, std::string(shape) + ": " + name + " is " + std::to_string(value) +
                                  " m, must be positive");
}

void check_not_negative(const char* shape, const char* name, double value) {
  if (std::isfinite(value) && value >= 0) return;
  throw Error(Trouble::input, std::string(shape) + ": " + name + " is " + std::to_string(value) +
                                  " m, must not be negative");
}

// Unit vector from the z axis to x; any direction on the axis itself.
Eigen::Vector3d radial_direction(const Eigen::Vector3d& x) {
  const double radius = std::hypot(x.x(), x.y());
  return radius > 0 ? Eigen::Vector3d(x.x() / radius, x.y() / radius, 0) : Eigen::Vector3d::UnitX();
}

// Field of the product of two slabs with excess u along unit direction a, v along b (a _|_ b).
DistanceField product_field(double u, const Eigen::Vector3d& a, double v,
                            const Eigen::Vector3d& b) {
  if (u > 0 && v > 0) {
    const double length = std::hypot(u, v);
    return {length, (u * a + v * b) / length};
  }
  return u > v ? DistanceField{u, a} : DistanceField{v, b};
}

DistanceField simple_field(const PlaneShape&, const Eigen::Vector3d& x) {
  return {x.z(), Eigen::Vector3d::UnitZ()};
}

DistanceField simple_field(const SphereShape& s, const Eigen::Vector3d& x) {
  const double length = x.norm();
  return {length - s.radius_m, length > 0 ? Eigen::Vector3d(x / length) : Eigen::Vector3d::UnitX()};
}

DistanceField simple_field(const CylinderShape& c, const Eigen::Vector3d& x) {
  const Eigen::Vector3d along(0, 0, x.z() < 0 ? -1 : 1);
  return product_field(std::hypot(x.x(), x.y()) - c.radius_m, radial_direction(x),
                       std::abs(x.z()) - c.height_m / 2, along);
}

DistanceField simple_field(const BoxShape& b, const Eigen::Vector3d& x) {
  const Eigen::Vector3d sign = x.unaryExpr([](double v) { return v < 0 ? -1.0 : 1.0; });
  const Eigen::Vector3d excess =
      x.cwiseAbs() - b.size_m / 2 + Eigen::Vector3d::Constant(b.rounding_m);
  const Eigen::Vector3d outside = excess.cwiseMax(0);
  if (const double length = outside.norm(); length > 0)
    return {length - b.rounding_m, outside.cwiseProduct(sign) / length};
  Eigen::Index axis;
  const double inside = excess.maxCoeff(&axis);
  return {inside - b.rounding_m, sign(axis) * Eigen::Vector3d::Unit(axis)};
}

DistanceField simple_field(const TorusShape& t, const Eigen::Vector3d& x) {
  const Eigen::Vector3d radial = radial_direction(x);
  const double u = std::hypot(x.x(), x.y()) - t.major_radius_m;
  const double length = std::hypot(u, x.z());
  const Eigen::Vector3d gradient =
      length > 0 ? Eigen::Vector3d((u * radial + Eigen::Vector3d(0, 0, x.z())) / length) : radial;
  return {length - t.minor_radius_m, gradient};
}

// Smooth minimum min(a, b) - h^2 k / 4 with h = max(k - |a - b|, 0) / k (quadratic polynomial);
// its gradient is a convex combination, so it stays 1-Lipschitz.
DistanceField smooth_minimum(const DistanceField& a, const DistanceField& b, double k) {
  const DistanceField& low = a.value_m <= b.value_m ? a : b;
  const DistanceField& high = a.value_m <= b.value_m ? b : a;
  if (k <= 0) return low;
  const double h = std::max(k - (high.value_m - low.value_m), 0.0) / k;
  return {low.value_m - h * h * k / 4, (1 - h / 2) * low.gradient + h / 2 * high.gradient};
}

DistanceField negated(const DistanceField& f) {
  return {-f.value_m, -f.gradient};
}

DistanceField simple_field(const CombinedShape& c, const Eigen::Vector3d& x) {
  using Operation = CombinedShape::Operation;
  DistanceField result = field(c.parts.front(), x);
  for (std::size_t i = 1; i < c.parts.size(); ++i) {
    const DistanceField part = field(c.parts[i], x);
    switch (c.operation) {
      case Operation::unite:
        result = smooth_minimum(result, part, c.blend_m);
        break;
      case Operation::intersect:
        result = negated(smooth_minimum(negated(result), negated(part), c.blend_m));
        break;
      case Operation::subtract:
        result = negated(smooth_minimum(negated(result), part, c.blend_m));
        break;
    }
  }
  return result;
}

Bounds local_bounds(const Shape& shape) {
  const auto symmetric = [](const Eigen::Vector3d& half) { return Bounds(-half, half); };
  return std::visit(
      Overloaded{
          [&](const PlaneShape&) {
            return Bounds(Eigen::Vector3d::Constant(-infinity),
                          Eigen::Vector3d(infinity, infinity, 0));
          },
          [&](const SphereShape& s) { return symmetric(Eigen::Vector3d::Constant(s.radius_m)); },
          [&](const CylinderShape& c) {
            return symmetric({c.radius_m, c.radius_m, c.height_m / 2});
          },
          [&](const BoxShape& b) { return symmetric(b.size_m / 2); },
          [&](const TorusShape& t) {
            const double reach = t.major_radius_m + t.minor_radius_m;
            return symmetric({reach, reach, t.minor_radius_m});
          },
          [&](const CombinedShape& c) {
            using Operation = CombinedShape::Operation;
            Bounds box = bounds_of(c.parts.front());
            for (std::size_t i = 1; i < c.parts.size(); ++i) {
              if (c.operation == Operation::unite) box.extend(bounds_of(c.parts[i]));
              if (c.operation == Operation::intersect)
                box = box.intersection(bounds_of(c.parts[i]));
            }
            // a smooth union bulges by at most a quarter of the blend width per joint
            const double bulge = c.operation == Operation::unite
                                     ? c.blend_m / 4 * static_cast<double>(c.parts.size() - 1)
                                     : 0.0;
            return Bounds(box.min() - Eigen::Vector3d::Constant(bulge),
                          box.max() + Eigen::Vector3d::Constant(bulge));
          }},
      shape);
}

}  // namespace

void check(const Shape& shape) {
  std::visit(
      Overloaded{[](const PlaneShape&) {},
                 [](const SphereShape& s) { check_positive("sphere", "radius", s.radius_m); },
                 [](const CylinderShape& c) {
                   check_positive("cylinder", "radius", c.radius_m);
                   check_positive("cylinder", "height", c.height_m);
                 },
                 [](const BoxShape& b) {
                   for (const double side : b.size_m) check_positive("box", "size", side);
                   check_not_negative("box", "rounding", b.rounding_m);
                   if (2 * b.rounding_m > b.size_m.minCoeff())
                     throw Error(Trouble::input, "box: rounding is " +
                                                     std::to_string(b.rounding_m) +
                                                     " m, at most half of the smallest side");
                 },
                 [](const TorusShape& t) {
                   check_positive("torus", "major radius", t.major_radius_m);
                   check_positive("torus", "minor radius", t.minor_radius_m);
                   if (t.minor_radius_m > t.major_radius_m)
                     throw Error(Trouble::input, "torus: minor radius is " +
                                                     std::to_string(t.minor_radius_m) +
                                                     " m, at most the major radius");
                 },
                 [](const CombinedShape& c) {
                   check_not_negative("combination", "blend", c.blend_m);
                   if (c.parts.empty()) throw Error(Trouble::input, "combination: no parts");
                   for (const PlacedShape& part : c.parts) check(part.shape);
                 }},
      shape);
}

DistanceField field(const Shape& shape, const Eigen::Vector3d& x) {
  return std::visit([&](const auto& s) { return simple_field(s, x); }, shape);
}

DistanceField field(const PlacedShape& placed, const Eigen::Vector3d& x) {
  const Eigen::Matrix3d rotation = placed.parent_from_shape.linear();
  const Eigen::Vector3d local = rotation.transpose() * (x - placed.parent_from_shape.translation());
  const DistanceField f = field(placed.shape, local);
  return {f.value_m, rotation * f.gradient};
}

Bounds bounds_of(const PlacedShape& placed) {
  const Bounds local = local_bounds(placed.shape);
  if (!local.min().allFinite() || !local.max().allFinite())
    return Bounds(Eigen::Vector3d::Constant(-infinity), Eigen::Vector3d::Constant(infinity));
  Bounds box;
  for (int corner = 0; corner < 8; ++corner)
    box.extend(placed.parent_from_shape * local.corner(static_cast<Bounds::CornerType>(corner)));
  return box;
}

}  // namespace scan
