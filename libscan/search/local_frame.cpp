// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/local_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/point_cloud.h"

namespace scan {
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

}  // namespace scan
