// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/local_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/point_cloud.h"

namespace scan {
namespace {

constexpr double largest_float = std::numeric_limits<float>::max();

}  // namespace

std::array<float, 3> LocalFrame::local(const Eigen::Vector3d& point_m) const {
  std::array<float, 3> u;
  for (int axis = 0; axis < 3; ++axis)
    u[axis] = static_cast<float>(
        std::clamp((point_m[axis] - origin_m[axis]) * units_per_m, -largest_float, largest_float));
  return u;
}

LocalFrame local_frame(std::span<const Eigen::Vector3d> points_m) {
  const Bounds box = bounds_of(points_m);
  if (box.isEmpty()) return {};
  LocalFrame frame{box.min() / 2 + box.max() / 2, 1};
  const double half_m =
      std::max((box.max() - frame.origin_m).maxCoeff(), (frame.origin_m - box.min()).maxCoeff());
  int exponent = 0;  // half_m < 2^exponent
  if (half_m > 0) std::frexp(half_m, &exponent);
  frame.units_per_m = std::ldexp(1.0, -std::clamp(exponent, -1000, 1000));
  return frame;
}

std::vector<LocalPoint> local_points(std::span<const Eigen::Vector3d> points_m,
                                     const LocalFrame& frame) {
  std::vector<LocalPoint> local;
  local.reserve(points_m.size());
  for (std::size_t i = 0; i < points_m.size(); ++i)
    if (points_m[i].allFinite())
      local.push_back({frame.local(points_m[i]), static_cast<std::uint32_t>(i)});
  return local;
}

LocalQuery::LocalQuery(const LocalFrame& frame, const Eigen::Vector3d& query_m)
    : at_m(query_m), at(frame.local(query_m)), units_per_m(frame.units_per_m) {
  const double largest = (query_m - frame.origin_m).cwiseAbs().maxCoeff() * units_per_m;
  slack = 0x1p-23 * (1 + largest);
}

}  // namespace scan
