// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Clouds that are hard on a neighbour search, each for its own reason.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "libscan/core/random.h"

namespace scan {

using Points = std::vector<Eigen::Vector3d>;

inline Eigen::Vector3d in_cube(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform();
  return {x, y, random.uniform()};
}

inline Eigen::Vector3d normal_vector(RandomStream& random) {
  const double x = random.normal(), y = random.normal();
  return {x, y, random.normal()};
}

// `draw(random, i)` for each i, from one stream.
template <class Draw>
Points drawn(std::size_t count, std::uint32_t stream, Draw&& draw) {
  RandomStream random(11, stream, 0);
  Points points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(draw(random, i));
  return points;
}

inline Points uniform_cloud(std::size_t count) {
  return drawn(count, 1, [](RandomStream& random, std::size_t) { return in_cube(random); });
}

// A unit sphere with a little noise along the normal, as a scanner sees it.
inline Points surface_cloud(std::size_t count) {
  return drawn(count, 2, [](RandomStream& random, std::size_t) -> Eigen::Vector3d {
    const Eigen::Vector3d direction = normal_vector(random).normalized();
    return direction * (1 + 1e-4 * random.normal());
  });
}

// Clusters whose sizes span nine orders of magnitude.
inline Points clustered_cloud(std::size_t count) {
  return drawn(count, 3, [](RandomStream& random, std::size_t i) -> Eigen::Vector3d {
    const auto cluster = static_cast<double>(i % 10);
    return Eigen::Vector3d(cluster, std::sin(cluster), 0) +
           std::pow(10.0, -cluster) * normal_vector(random);
  });
}

// Each of a few places occupied many times.
inline Points duplicate_cloud(std::size_t count) {
  const Points places = uniform_cloud(7);
  return drawn(count, 4, [&](RandomStream& random, std::size_t) {
    return places[random.bits32() % places.size()];
  });
}

// Integer coordinates: distances tie by the dozen, exactly.
inline Points lattice_cloud(int side) {
  Points points;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z) points.emplace_back(x, y, z);
  return points;
}

inline Points collinear_cloud(std::size_t count) {
  return drawn(count, 5, [](RandomStream& random, std::size_t) -> Eigen::Vector3d {
    return random.uniform() * Eigen::Vector3d(1, 2, -3);
  });
}

// A plane across the axes, at whose points the normal direction has rounding only.
inline Points coplanar_cloud(std::size_t count) {
  return drawn(count, 6, [](RandomStream& random, std::size_t) -> Eigen::Vector3d {
    const double a = random.uniform(), b = random.uniform();
    return a * Eigen::Vector3d(1, 2, -3) + b * Eigen::Vector3d(3, 0, 1);
  });
}

// Every other point in a cube of a hundredth of the side: a million times as dense.
inline Points uneven_cloud(std::size_t count) {
  return drawn(count, 7, [](RandomStream& random, std::size_t i) -> Eigen::Vector3d {
    return (i % 2 == 0 ? 1 : 0.01) * in_cube(random);
  });
}

// Ever nearer to the middle, down to the least float: the deepest octree there is.
inline Points halved_cloud(std::size_t count) {
  Points points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(std::ldexp(i % 2 == 0 ? 1 : -1, -static_cast<int>(i / 2 % 148)), 0, 0);
  return points;
}

inline Points moved(Points points, double scale, const Eigen::Vector3d& offset) {
  for (auto& point : points) point = scale * point + offset;
  return points;
}

// Every eleventh point is not a number or infinite in one coordinate.
inline Points with_holes(Points points) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < points.size(); i += 11)
    points[i][static_cast<Eigen::Index>(i / 11 % 3)] = bad[i / 33 % 3];
  return points;
}

struct NamedCloud {
  std::string name;
  Points points;
};

inline std::vector<NamedCloud> hard_clouds(std::size_t count) {
  const Eigen::Vector3d far(1e7, -1e7, 1e7), none = Eigen::Vector3d::Zero();
  return {{"empty", {}},
          {"single", uniform_cloud(1)},
          {"pair", uniform_cloud(2)},
          {"identical", Points(count, {0.1, 0.2, 0.3})},
          {"uniform", uniform_cloud(count)},
          {"surface", surface_cloud(count)},
          {"clustered", clustered_cloud(count)},
          {"duplicates", duplicate_cloud(count)},
          {"lattice", lattice_cloud(static_cast<int>(std::cbrt(static_cast<double>(count))))},
          {"collinear", collinear_cloud(count)},
          {"coplanar", coplanar_cloud(count)},
          {"uneven", uneven_cloud(count)},
          {"halved", halved_cloud(count)},
          {"holes", with_holes(uniform_cloud(count))},
          {"only holes", Points(20, Eigen::Vector3d::Constant(std::nan("")))},
          {"far", moved(surface_cloud(count), 1, far)},
          {"far and fine", moved(surface_cloud(count), 1e-3, far)},
          {"far and small", moved(surface_cloud(count), 1e-6, far)},
          {"tiny", moved(uniform_cloud(count), 1e-6, none)},
          {"huge", moved(uniform_cloud(count), 1e6, none)},
          {"beyond float", moved(uniform_cloud(count), 1e60, none)},
          {"below float", moved(uniform_cloud(count), 1e-60, none)}};
}

}  // namespace scan
