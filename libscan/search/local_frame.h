// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Single-precision copies of points and queries, and how far they can be trusted: a search may pass
// by a point only if its float distance exceeds what rounding can explain. Internal to
// libscan/search.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "libscan/search/large_array.h"
#include "libscan/search/neighbour_search.h"

namespace scan {

// A finite point of a cloud: its local coordinates and its index there.
struct LocalPoint {
  std::array<float, 3> at;
  std::uint32_t index;
};

// Local coordinates u = (x - origin) * units_per_m; units_per_m is a power of two, so scaling is
// exact, and the points of the cloud have |u| < 1 on each axis: neither their offset nor their
// scale costs a bit.
struct LocalFrame {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double units_per_m = 1;

  std::array<float, 3> local(const Eigen::Vector3d& point_m) const {
    constexpr double largest = std::numeric_limits<float>::max();
    std::array<float, 3> u;
    for (int axis = 0; axis < 3; ++axis)
      u[axis] = static_cast<float>(
          std::clamp((point_m[axis] - origin_m[axis]) * units_per_m, -largest, largest));
    return u;
  }
};

// The frame of the finite points.
LocalFrame local_frame(std::span<const Eigen::Vector3d> points_m);

// The finite points in the frame, in their order.
LargeArray<LocalPoint> local_points(std::span<const Eigen::Vector3d> points_m,
                                    const LocalFrame& frame);

// A query in the frame.
//
// Let d be the true distance to a point in local units. Rounding both to float moves each by at
// most 2^-24 of its largest coordinate on each axis, the query's being |q|: the distance d' of the
// rounded ones obeys |d' - d| <= sqrt(3) 2^-24 (1 + |q|) < 2^-23 (1 + |q|) =: slack. The float
// value of d'^2, of a sum of three squares of differences, is d'^2 (1 + t), |t| <= 6 * 2^-24. So a
// point with d <= L has a float value of at most (L + slack)^2 (1 + 2^-20), rounding of this bound
// and of the double values included. The same holds for the distance to a box of rounded points.
//
// Conversely a point with the float value f has d <= sqrt(f) (1 + 2^-22) + slack. So all that may
// be as near as it have float values of at most (sqrt(f) (1 + 2^-22) + 2 slack)^2 (1 + 2^-20);
// computed in float, with six more roundings of 2^-24, by widened() with 2^-19 and 2^-18.
struct LocalQuery {
  LocalQuery(const LocalFrame& frame, const Eigen::Vector3d& query_m)
      : at_m(query_m),
        at(frame.local(query_m)),
        units_per_m(frame.units_per_m),
        slack(0x1p-23 * (1 + (query_m - frame.origin_m).cwiseAbs().maxCoeff() * units_per_m)) {}

  // The float value above which a squared distance in local units is certainly above limit2_m2.
  float limit2(double limit2_m2) const {
    if (!(limit2_m2 >= 0)) return -1;
    if (limit2_m2 == unlimited_m) return std::numeric_limits<float>::infinity();
    const double limit = std::sqrt(limit2_m2) * units_per_m + slack;
    const double bound = limit * limit * (1 + 0x1p-20);
    constexpr double largest = std::numeric_limits<float>::max();
    return bound < largest ? static_cast<float>(bound) : std::numeric_limits<float>::infinity();
  }

  // By how much the float distances of two points may differ while their true ones are equal.
  float widening() const { return static_cast<float>(std::min(2 * slack, 1e38)); }

  Eigen::Vector3d at_m;
  std::array<float, 3> at;
  double units_per_m;
  double slack;
};

}  // namespace scan
