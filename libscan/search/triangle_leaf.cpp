// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/triangle_leaf.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace scan {
namespace {

// Of length 1, or 0 where there is no direction: below, squares of lengths lose digits.
Eigen::Vector3f direction_of(const Eigen::Vector3d& vector) {
  constexpr double shortest = 1e-100;
  const double length = vector.norm();
  if (!(length > shortest)) return Eigen::Vector3f::Zero();
  return (vector / length).cast<float>();
}

}  // namespace

void TriangleLeaf::set(int lane, const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::Vector3d &a = corners[0], &b = corners[1], &c = corners[2];
  const Eigen::Vector3f of_plane = direction_of((b - a).cross(c - a));
  const auto along = [&](const Eigen::Vector3f& n) {
    const Eigen::Vector3d direction = n.cast<double>();
    return std::minmax({direction.dot(a), direction.dot(b), direction.dot(c)});
  };
  const auto [least, most] = along(of_plane);
  low[lane] = static_cast<float>(least);
  high[lane] = static_cast<float>(most);
  for (int axis = 0; axis < 3; ++axis) normal[axis][lane] = of_plane[axis];
  for (int edge = 0; edge < 3; ++edge) {
    const auto k = static_cast<std::size_t>(edge);
    const Eigen::Vector3d way = corners[(k + 1) % 3] - corners[k];
    // A needle's normal is what rounding left of it. It can lie along the needle only where one of
    // its coordinates is 0 (three roundings would all have to be at their most), and then what
    // rounding leaves of this product is across it.
    const Eigen::Vector3f out = direction_of(way.cross(of_plane.cast<double>()));
    reach[edge][lane] = static_cast<float>(along(out).second);
    for (int axis = 0; axis < 3; ++axis) outward[edge][axis][lane] = out[axis];
  }
}

}  // namespace scan
