// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/triangle.h"

#include <utility>

namespace scan::synth {
namespace {

Eigen::Vector3d in_ray_frame(const ShearedRay& ray, const Eigen::Vector3d& x) {
  const Eigen::Vector3d v = x - ray.origin;
  const double z = v(ray.axis[2]);
  return {v(ray.axis[0]) - ray.shear.x() * z, v(ray.axis[1]) - ray.shear.y() * z, z};
}

}  // namespace

ShearedRay sheared(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  Eigen::Index z;
  direction.cwiseAbs().maxCoeff(&z);
  int x = static_cast<int>(z + 1) % 3, y = static_cast<int>(z + 2) % 3;
  if (direction(z) < 0) std::swap(x, y);
  return {origin,
          {direction(x) / direction(z), direction(y) / direction(z), 1 / direction(z)},
          {x, y, static_cast<int>(z)}};
}

std::optional<double> line_distance(const ShearedRay& ray, const Eigen::Vector3d& a_in_world,
                                    const Eigen::Vector3d& b_in_world,
                                    const Eigen::Vector3d& c_in_world) {
  const Eigen::Vector3d a = in_ray_frame(ray, a_in_world);
  const Eigen::Vector3d b = in_ray_frame(ray, b_in_world);
  const Eigen::Vector3d c = in_ray_frame(ray, c_in_world);
  const double u = c.x() * b.y() - c.y() * b.x();
  const double v = a.x() * c.y() - a.y() * c.x();
  const double w = b.x() * a.y() - b.y() * a.x();
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
  const double determinant = u + v + w;
  if (determinant == 0) return std::nullopt;
  return (u * a.z() + v * b.z() + w * c.z()) / determinant * ray.shear.z();
}

}  // namespace scan::synth
