// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Oriented exact samples of solids with sharp edges.
#pragma once

#include <algorithm>

#include "tests/reconstruct/shapes.h"

namespace scan {

// A rectangle's uniform samples, 2,000 to the square metre of a cloud of 12,000 on a unit cube.
inline void add_rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b, std::size_t per_m2, RandomStream& random,
                          PointCloud& cloud) {
  const Eigen::Vector3d across = a.cross(b);
  const auto count = static_cast<std::size_t>(static_cast<double>(per_m2) * across.norm());
  for (std::size_t i = 0; i < count; ++i) {
    const double u = random.uniform(), v = random.uniform();
    cloud.points.push_back(corner + u * a + v * b);
    cloud.normals.push_back(across.normalized());
  }
}

// A side of a box, a direction of `axis` times `side` outwards.
inline void add_box_side(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int axis,
                         double side, std::size_t per_m2, RandomStream& random, PointCloud& cloud) {
  const Eigen::Vector3d size = high - low;
  Eigen::Vector3d corner = low;
  if (side > 0) corner[axis] = high[axis];
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (side < 0) std::swap(u, v);
  add_rectangle(corner, size[u] * Eigen::Vector3d::Unit(u), size[v] * Eigen::Vector3d::Unit(v),
                per_m2, random, cloud);
}

// The cube from -0.5 to 0.5.
inline PointCloud cube_cloud(std::size_t count, std::uint64_t seed = 1) {
  PointCloud cloud;
  RandomStream random(seed, 0, 0);
  const Eigen::Vector3d high = Eigen::Vector3d::Constant(0.5);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      add_box_side(-high, high, axis, side, count / 6, random, cloud);
  return cloud;
}

inline double from_cube(const Eigen::Vector3d& x) {
  const Eigen::Vector3d q = x.cwiseAbs() - Eigen::Vector3d::Constant(0.5);
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

// The cube from -0.5 to 0.5 without the quarter of positive x and z: a step, with a concave edge
// along y.
inline PointCloud step_cloud(std::size_t per_5_m2, std::uint64_t seed = 1) {
  PointCloud cloud;
  RandomStream random(seed, 0, 0);
  const std::size_t per_m2 = per_5_m2 / 15;
  const double h = 0.5;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  add_rectangle({-h, -h, -h}, y, x, per_m2, random, cloud);     // below
  add_rectangle({-h, -h, -h}, z, y, per_m2, random, cloud);     // back
  add_rectangle({-h, -h, h}, h * x, y, per_m2, random, cloud);  // top
  add_rectangle({0, -h, 0}, h * x, y, per_m2, random, cloud);   // tread
  add_rectangle({0, -h, 0}, y, h * z, per_m2, random, cloud);   // riser
  add_rectangle({h, -h, -h}, y, h * z, per_m2, random, cloud);  // front
  for (const double side : {-1.0, 1.0}) {
    add_box_side({-h, -h, -h}, {h, h, 0}, 1, side, per_m2, random, cloud);
    add_box_side({-h, -h, 0}, {0, h, h}, 1, side, per_m2, random, cloud);
  }
  return cloud;
}

// The cylinder of radius 0.5 about z from -0.5 to 0.5, with its lids.
inline PointCloud can_cloud(std::size_t count, std::uint64_t seed = 1) {
  PointCloud cloud;
  RandomStream random(seed, 0, 0);
  while (cloud.size() < count) {
    const double which = random.uniform(), angle = 2 * std::numbers::pi * random.uniform();
    const double share = random.uniform();
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
    if (which < 2.0 / 3) {  // the side's share of the area
      cloud.points.push_back(0.5 * out + (share - 0.5) * Eigen::Vector3d::UnitZ());
      cloud.normals.push_back(out);
    } else {
      const double side = which < 5.0 / 6 ? 1 : -1;
      cloud.normals.push_back(side * Eigen::Vector3d::UnitZ());
      cloud.points.push_back(0.5 * std::sqrt(share) * out + 0.5 * cloud.normals.back());
    }
  }
  return cloud;
}

}  // namespace scan
