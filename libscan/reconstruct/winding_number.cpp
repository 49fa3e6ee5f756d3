// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/winding_number.h"

#include <cmath>
#include <map>
#include <numbers>

namespace scan {
namespace {

constexpr int cells = 32;

}  // namespace

WindingNumber::WindingNumber(const Samples& samples) {
  std::map<std::array<int, 3>, Group> groups;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Eigen::Vector3d& x = samples.points[i];
    Group& group = groups[{static_cast<int>(std::floor(cells * x[0])),
                           static_cast<int>(std::floor(cells * x[1])),
                           static_cast<int>(std::floor(cells * x[2]))}];
    group.place += samples.area[i] * x;
    group.normal += samples.area[i] / (4 * std::numbers::pi) * samples.normals[i];
    group.area += samples.area[i];
  }
  double area = 0;
  for (const auto& [cell, group] : groups) {
    groups_.push_back(group);
    groups_.back().place /= group.area;
  }
  for (const Group& group : groups_) {
    on_surface_ += group.area * at(group.place);
    area += group.area;
  }
  on_surface_ /= area;
}

double WindingNumber::at(const Eigen::Vector3d& x) const {
  double sum = 0;
  for (const Group& group : groups_) {
    const Eigen::Vector3d d = group.place - x;
    const double distance2 = d.squaredNorm();
    if (distance2 > 0) sum += group.normal.dot(d) / (distance2 * std::sqrt(distance2));
  }
  return sum;
}

}  // namespace scan
