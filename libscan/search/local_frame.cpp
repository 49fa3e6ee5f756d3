// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/search/local_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "libscan/core/parallel.h"
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

LargeArray<LocalPoint> local_points(std::span<const Eigen::Vector3d> points_m,
                                    const LocalFrame& frame) {
  constexpr std::size_t chunk = 16384;
  std::vector<std::size_t> first(points_m.size() / chunk + 2, 0);  // finite points before a chunk
  parallel_chunks(points_m.size(), chunk, [&](std::size_t begin, std::size_t end) {
    const auto part = points_m.subspan(begin, end - begin);
    first[begin / chunk + 1] = static_cast<std::size_t>(std::count_if(
        part.begin(), part.end(), [](const Eigen::Vector3d& point) { return point.allFinite(); }));
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  LargeArray<LocalPoint> local(first.back());
  parallel_chunks(points_m.size(), chunk, [&](std::size_t begin, std::size_t end) {
    LocalPoint* next = local.data() + first[begin / chunk];
    for (std::size_t i = begin; i < end; ++i)
      if (points_m[i].allFinite())
        *next++ = {frame.local(points_m[i]), static_cast<std::uint32_t>(i)};
  });
  return local;
}

}  // namespace scan
