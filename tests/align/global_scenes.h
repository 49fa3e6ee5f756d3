// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scenes for alignment without a first guess: one that has one answer, and some that have several.
#pragma once

#include "tests/align/test_shapes.h"

namespace scan::test {

// The points whose normals face `direction` by more than `least` (cosine).
inline PointCloud facing(const PointCloud& cloud, const Vector3d& direction, double least) {
  std::vector<std::uint32_t> seen;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.normals[i].dot(direction.normalized()) > least) seen.push_back(i);
  return subset(cloud, seen);
}

// A point of the surface of a box about the origin, with the outward normal; larger faces get more.
inline std::pair<Vector3d, Vector3d> on_box(RandomStream& r, const Vector3d& size) {
  const Vector3d areas(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
  double pick = r.uniform() * areas.sum();
  int axis = 0;
  while (axis < 2 && pick > areas[axis]) pick -= areas[axis++];
  const double side = r.bits32() % 2 == 0 ? 1 : -1;
  const double u = r.uniform() - 0.5, v = r.uniform() - 0.5;
  Vector3d x;
  x[axis] = side * size[axis] / 2;
  x[(axis + 1) % 3] = u * size[(axis + 1) % 3];
  x[(axis + 2) % 3] = v * size[(axis + 2) % 3];
  return {x, side * Vector3d::Unit(axis)};
}

inline PointCloud box(std::size_t count, const Vector3d& size, std::uint64_t seed) {
  return sampled(count, seed, [&](RandomStream& r) { return on_box(r, size); });
}

inline PointCloud turned_inside_out(PointCloud cloud) {
  for (Vector3d& n : cloud.normals) n = -n;
  return cloud;
}

// The walls of a room of 4 x 4 x 4 m from inside: 24 rotations carry it into itself.
inline PointCloud cube_room(std::size_t count, std::uint64_t seed) {
  return turned_inside_out(box(count, {4, 4, 4}, seed));
}

// A room of 5 x 4 x 3 m with three pieces of furniture: no motion carries it into itself.
inline PointCloud furnished_room(std::size_t count, std::uint64_t seed) {
  PointCloud room = turned_inside_out(box(count / 2, {5, 4, 3}, seed));
  const auto put = [&](const Vector3d& size, const Vector3d& at, std::uint64_t of) {
    append(room, transformed(Pose(Eigen::Translation3d(at)), box(count / 6, size, of)));
  };
  put({1.6, 0.8, 0.7}, {-1, 0.4, -1.1}, seed + 1000);
  put({0.6, 0.6, 1.8}, {2, -1.5, -0.5}, seed + 2000);
  put({0.5, 1.5, 1.0}, {1.6, 1.1, -0.9}, seed + 3000);
  return room;
}

// A floor with columns + rows of pillars, 2 m apart, 0.5 m wide and 1.5 m high; first one at x, y.
inline PointCloud pillars(int columns, int rows, double x, double y, std::size_t count,
                          std::uint64_t seed) {
  return sampled(count, seed, [&](RandomStream& r) {
    const double u = r.uniform(), v = r.uniform();
    if (r.uniform() < 0.4)
      return std::pair(Vector3d(x - 1 + 2 * columns * u, y - 1 + 2 * rows * v, 0),
                       Vector3d(0, 0, 1));
    const Vector3d foot(x + 2 * std::floor(columns * u), y + 2 * std::floor(rows * v), 0.75);
    const auto [at, normal] = on_box(r, {0.5, 0.5, 1.5});
    return std::pair(Vector3d(foot + at), normal);
  });
}

}  // namespace scan::test
