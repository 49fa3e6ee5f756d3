// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One shape of every kind and of every combination, each with what lies inside it.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "libscan/core/random.h"
#include "libscan/core/shape.h"

namespace scan::test {

using Operation = CombinedShape::Operation;

inline Pose pose_of(double rx, double ry, double rz, double x, double y, double z) {
  Vector6 twist;
  twist << rx, ry, rz, 0, 0, 0;
  return make_pose(exp(twist).linear(), {x, y, z});
}

inline PlacedShape at(double x, double y, double z, Shape shape) {
  return {pose_of(0, 0, 0, x, y, z), std::move(shape)};
}

struct ShapeCase {
  std::string name;
  Shape shape;
  std::function<bool(const Eigen::Vector3d&)> inside;  // written without any distance
};

inline bool in_box(const Eigen::Vector3d& x, const Eigen::Vector3d& size) {
  return (x.cwiseAbs().array() < size.array() / 2).all();
}

inline std::vector<ShapeCase> simple_cases() {
  return {
      {"plane", PlaneShape{}, [](const auto& x) { return x.z() < 0; }},
      {"sphere", SphereShape{0.7}, [](const auto& x) { return x.squaredNorm() < 0.49; }},
      {"cylinder", CylinderShape{0.4, 1.2},
       [](const auto& x) { return x.x() * x.x() + x.y() * x.y() < 0.16 && std::abs(x.z()) < 0.6; }},
      {"box", BoxShape{{1, 0.8, 0.6}, 0},
       [](const auto& x) {
         return in_box(x, {1, 0.8, 0.6});
       }},
      {"rounded box", BoxShape{{1, 0.8, 0.6}, 0.1},
       [](const auto& x) {
         const Eigen::Vector3d core =
             x.cwiseMax(Eigen::Vector3d(-0.4, -0.3, -0.2)).cwiseMin(Eigen::Vector3d(0.4, 0.3, 0.2));
         return (x - core).squaredNorm() < 0.01;
       }},
      {"torus", TorusShape{0.6, 0.2},
       [](const auto& x) {  // the quartic
         const double k = x.squaredNorm() + 0.36 - 0.04;
         return k * k < 4 * 0.36 * (x.x() * x.x() + x.y() * x.y());
       }},
  };
}

inline std::vector<ShapeCase> combined_cases() {
  const auto combine = [](Operation operation, double blend, std::vector<PlacedShape> parts) {
    return CombinedShape{operation, blend, std::move(parts)};
  };
  const auto in_sphere = [](const Eigen::Vector3d& x, double cx, double r) {
    return (x - Eigen::Vector3d(cx, 0, 0)).norm() < r;
  };
  const PlacedShape tilted{pose_of(0.7, 0.2, 0, 0, 0, 0), BoxShape{{2, 2, 0.5}, 0}};
  const Pose from_tilted = tilted.parent_from_shape.inverse();
  return {
      {"two spheres",
       combine(Operation::unite, 0,
               {at(-0.3, 0, 0, SphereShape{0.5}), at(0.3, 0, 0, SphereShape{0.4})}),
       [=](const auto& x) { return in_sphere(x, -0.3, 0.5) || in_sphere(x, 0.3, 0.4); }},
      {"lens",
       combine(Operation::intersect, 0,
               {at(-0.3, 0, 0, SphereShape{0.5}), at(0.3, 0, 0, SphereShape{0.6})}),
       [=](const auto& x) { return in_sphere(x, -0.3, 0.5) && in_sphere(x, 0.3, 0.6); }},
      {"drilled box",
       combine(Operation::subtract, 0,
               {at(0, 0, 0, BoxShape{{1, 0.8, 0.6}, 0}), at(0.1, 0, 0, CylinderShape{0.2, 2})}),
       [](const auto& x) {
         return in_box(x, {1, 0.8, 0.6}) && !(std::hypot(x.x() - 0.1, x.y()) < 0.2);
       }},
      {"acute wedge",
       combine(Operation::intersect, 0, {at(0, 0, 0, BoxShape{{1.2, 1.2, 0.5}, 0}), tilted}),
       [=](const auto& x) {
         return in_box(x, {1.2, 1.2, 0.5}) && in_box(from_tilted * x, {2, 2, 0.5});
       }},
  };
}

// Blends have no closed form of their inside other than the field itself.
inline Shape filleted() {
  return CombinedShape{
      Operation::unite,
      0.1,
      {at(0, 0, 0, BoxShape{{1, 0.8, 0.3}, 0}), at(0, 0, 0.2, CylinderShape{0.2, 0.6})}};
}

inline std::vector<ShapeCase> all_cases() {
  std::vector<ShapeCase> cases = simple_cases();
  for (ShapeCase& c : combined_cases()) cases.push_back(std::move(c));
  return cases;
}

inline Eigen::Vector3d point_in_cube(RandomStream& random, double half) {
  return half * Eigen::Vector3d(2 * random.uniform() - 1, 2 * random.uniform() - 1,
                                2 * random.uniform() - 1);
}

// Points of the zero set found by marching along random lines: dense, not tied to closest_point.
inline std::vector<Eigen::Vector3d> surface_points(const Shape& shape, std::uint64_t lines) {
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < lines; ++i) {
    RandomStream random(6, 0, i);
    const Eigen::Vector3d from = point_in_cube(random, 1.2), to = point_in_cube(random, 1.2);
    double last = field(shape, from).value_m;
    for (int step = 1; step <= 60; ++step) {
      double low = (step - 1) / 60.0, high = step / 60.0;
      const double value = field(shape, from + high * (to - from)).value_m;
      if ((value > 0) != (last > 0)) {
        for (int k = 0; k < 50; ++k) {
          const double middle = (low + high) / 2;
          const bool same = (field(shape, from + middle * (to - from)).value_m > 0) == (last > 0);
          (same ? low : high) = middle;
        }
        points.push_back(from + low * (to - from));
      }
      last = value;
    }
  }
  return points;
}

}  // namespace scan::test
