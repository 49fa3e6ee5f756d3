// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Shapes that slide or turn within themselves, sampled at random, with exact normals.
#pragma once

#include "tests/align/test_clouds.h"

namespace scan::test {

// Calls sample(random) -> {point, normal} for each of `count` points.
template <class Sample>
PointCloud sampled(std::size_t count, std::uint64_t seed, Sample&& sample) {
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(seed, 7, i);
    const std::pair<Vector3d, Vector3d> found = sample(random);
    cloud.points.push_back(found.first);
    cloud.normals.push_back(found.second.normalized());
  }
  return cloud;
}

// 10 x 10 m, z = 0.
inline PointCloud plane(std::size_t count, std::uint64_t seed) {
  return sampled(count, seed, [](RandomStream& r) {
    return std::pair(Vector3d(10 * r.uniform() - 5, 10 * r.uniform() - 5, 0), Vector3d(0, 0, 1));
  });
}

// Four walls of a corridor of 2 x 2 m, 30 m along x, normals inwards.
inline PointCloud corridor(std::size_t count, std::uint64_t seed) {
  return sampled(count, seed, [](RandomStream& r) {
    const double x = 30 * r.uniform() - 15, u = 2 * r.uniform() - 1;
    switch (r.bits32() % 4) {
      case 0:
        return std::pair(Vector3d(x, u, -1), Vector3d(0, 0, 1));
      case 1:
        return std::pair(Vector3d(x, u, 1), Vector3d(0, 0, -1));
      case 2:
        return std::pair(Vector3d(x, -1, u), Vector3d(0, 1, 0));
      default:
        return std::pair(Vector3d(x, 1, u), Vector3d(0, -1, 0));
    }
  });
}

// Radius 1 m.
inline PointCloud sphere(std::size_t count, std::uint64_t seed) {
  return sampled(count, seed, [](RandomStream& r) {
    const Vector3d n = random_direction(r);
    return std::pair(n, n);
  });
}

// Radius 1 m, z in [-2, 2], with both lids.
inline std::pair<Vector3d, Vector3d> on_closed_cylinder(RandomStream& r) {
  const double angle = 2 * std::numbers::pi * r.uniform();
  const Vector3d out(std::cos(angle), std::sin(angle), 0);
  if (r.uniform() < 0.8) return {out + (4 * r.uniform() - 2) * Vector3d::UnitZ(), out};
  const double side = r.uniform() < 0.5 ? -1 : 1;
  return {std::sqrt(r.uniform()) * out + 2 * side * Vector3d::UnitZ(), side * Vector3d::UnitZ()};
}
inline PointCloud closed_cylinder(std::size_t count, std::uint64_t seed) {
  return sampled(count, seed, on_closed_cylinder);
}

// The same with a fin, `share` of the points: a plane through the axis from radius 1 to 1.5.
inline PointCloud cylinder_with_fin(std::size_t count, double share, std::uint64_t seed) {
  return sampled(count, seed, [share](RandomStream& r) {
    if (r.uniform() >= share) return on_closed_cylinder(r);
    const double side = r.uniform() < 0.5 ? -1 : 1;
    return std::pair(Vector3d(1 + 0.5 * r.uniform(), 0.02 * side, 4 * r.uniform() - 2),
                     Vector3d(0, side, 0));
  });
}

// Apex at z = 2, radius 1 at z = 0, with its base.
inline PointCloud cone(std::size_t count, std::uint64_t seed) {
  return sampled(count, seed, [](RandomStream& r) {
    const double angle = 2 * std::numbers::pi * r.uniform(), radius = std::sqrt(r.uniform());
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    if (r.uniform() < 0.3) return std::pair(Vector3d(radius * out), Vector3d(-Vector3d::UnitZ()));
    return std::pair(Vector3d(radius * out + 2 * (1 - radius) * Vector3d::UnitZ()),
                     Vector3d(2 * out + Vector3d::UnitZ()));
  });
}

// A spiral ramp of pitch 0.5 m per radian, radius 0.3 to 1 m, two turns.
inline PointCloud spiral_ramp(std::size_t count, std::uint64_t seed) {
  return sampled(count, seed, [](RandomStream& r) {
    const double angle = 4 * std::numbers::pi * r.uniform(), radius = 0.3 + 0.7 * r.uniform();
    const Vector3d out(std::cos(angle), std::sin(angle), 0), along(-out.y(), out.x(), 0);
    const Vector3d tangent = radius * along + 0.5 * Vector3d::UnitZ();
    return std::pair(Vector3d(radius * out + 0.5 * angle * Vector3d::UnitZ()), out.cross(tangent));
  });
}

// A lump without symmetry: a unit sphere whose radius varies with the direction.
inline PointCloud lump(std::size_t count, std::uint64_t seed) {
  PointCloud cloud = sphere(count, seed);
  for (Vector3d& x : cloud.points)
    x *= 1 + 0.25 * std::sin(3 * x.x() + 1) * std::cos(2 * x.y()) + 0.2 * x.z() * x.x() +
         0.1 * std::sin(5 * x.z()) * std::cos(6 * x.x());
  estimate_normals(cloud, [](const Vector3d& x) { return x; });
  return cloud;
}

}  // namespace scan::test
