// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scenes of mirrors and glass, and the laws that every way over them must obey.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "synth/transport/connection.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

inline Material mirror_material() {
  return {.name = "mirror", .bsdf = Conductor{.eta = 0.2, .k = 6, .roughness = 0}};
}
inline Material glass_material(double index = 1.5) {
  return {.name = "glass", .bsdf = Dielectric{.index = index}};
}

inline Object placed(const Shape& shape, int material, const Eigen::Vector3d& centre,
                     const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity()) {
  return {.name = "object",
          .world_from_object = make_pose(rotation, centre),
          .geometry = shape,
          .material = material};
}

inline Eigen::Matrix3d turn_about_y(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
}

// Optical length of a way over the bends from `at` to `light` with an index for each part.
inline double optical_length(const Eigen::Vector3d& at, const std::vector<Eigen::Vector3d>& bends,
                             const Eigen::Vector3d& light, const std::vector<double>& indices) {
  Eigen::Vector3d point = at;
  double length = 0;
  for (std::size_t i = 0; i <= bends.size(); ++i) {
    const Eigen::Vector3d& next = i < bends.size() ? bends[i] : light;
    length += indices[i] * (next - point).norm();
    point = next;
  }
  return length;
}

// Fermat's principle by differences: the optical length of the way does not change, to first order,
// if a bend moves on its surface. It implies Snell's law and the law of reflection. Central
// differences over a step h err by h^2 / 6 of the third derivative, which is at most
// 3 cos^2 sin n / d^2 < 1.2 n / d^2 for a part of length d, and by the rounding of the length over
// h. A way is solved to 1e-10 of its length at the light.
inline void expect_stationary(const Scene& scene, const std::vector<int>& objects,
                              const Eigen::Vector3d& at, const Eigen::Vector3d& light,
                              const Connection& way, const std::vector<double>& indices) {
  ASSERT_EQ(static_cast<std::size_t>(way.bounces), objects.size());
  const std::vector<Eigen::Vector3d> bends(way.bends.begin(), way.bends.begin() + way.bounces);
  EXPECT_NEAR(optical_length(at, bends, light, indices), way.optical_m, 1e-12 * way.optical_m);
  EXPECT_NEAR(optical_length(at, bends, light, std::vector<double>(bends.size() + 1, 1)),
              way.length_m, 1e-12 * way.length_m);
  EXPECT_LT((way.arriving - (bends.front() - at).normalized()).norm(), 1e-11);
  EXPECT_LT((way.emitted - (bends.back() - light).normalized()).norm(), 1e-11);
  const double step_m = 1e-6;
  for (std::size_t i = 0; i < bends.size(); ++i) {
    const Object& object = scene.objects[objects[i]];
    const PlacedShape shape{object.world_from_object, std::get<Shape>(object.geometry)};
    EXPECT_LT(std::abs(field(shape, bends[i]).value_m), 1e-12);
    const Eigen::Vector3d normal = field(shape, bends[i]).gradient.normalized();
    const double before_m = (bends[i] - (i == 0 ? at : bends[i - 1])).norm();
    const double behind_m = ((i + 1 == bends.size() ? light : bends[i + 1]) - bends[i]).norm();
    const double tolerance =
        step_m * step_m *
            (indices[i] / (before_m * before_m) + indices[i + 1] / (behind_m * behind_m)) +
        1e-15 * way.optical_m / step_m;
    const Eigen::Vector3d tangent = normal.unitOrthogonal();
    for (const Eigen::Vector3d& direction : {tangent, Eigen::Vector3d(normal.cross(tangent))}) {
      const auto moved = [&](double distance_m) {
        auto others = bends;
        others[i] = closest_point(shape, bends[i] + distance_m * direction);
        return optical_length(at, others, light, indices);
      };
      EXPECT_NEAR((moved(step_m) - moved(-step_m)) / (2 * step_m), 0, tolerance) << "bend " << i;
    }
  }
}

// The ways of that number of bounces.
inline std::vector<Connection> with_bounces(const std::vector<Connection>& ways, int bounces) {
  std::vector<Connection> found;
  for (const Connection& way : ways)
    if (way.bounces == bounces) found.push_back(way);
  return found;
}

// Zero of a function that changes sign between a and b.
template <class Function>
double bisect(double a, double b, const Function& f) {
  const bool rises = f(b) > 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = (a + b) / 2;
    ((f(middle) > 0) == rises ? b : a) = middle;
  }
  return (a + b) / 2;
}

}  // namespace scan::synth
