// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far the farthest point of one mesh lies from another, between proven bounds.
#pragma once

#include <limits>

#include "libscan/search/closest_point.h"

namespace scan {

struct DistanceBounds {
  double low_m = 0;
  double high_m = 0;
};

struct HausdorffOptions {
  double widest_share = 0.01;  // of the bounds' distance in the lower one; and at least
  double least_m = 0;          // this far from each other they need not be nearer
  // Where only this is asked: whether the distance is at most so much. Then `high_m` is, or it is
  // infinite: there is a place beyond, or more queries are needed. No more is done than that takes.
  double limit_m = std::numeric_limits<double>::infinity();
  std::size_t most_queries = 1'000'000;  // within triangles; then the bounds are as they are
};

// The one-sided Hausdorff distance, of any point on `from` to the nearest on `to`, by branch and
// bound (after Tang, Lee and Kim 2009). low: the distance of the farthest corner of any piece that
// was looked at. high: the distance to one triangle is convex, so in a piece it is largest at a
// corner; and no distance grows faster than one moves. Throws scan::Error (input) for a broken mesh
// or one without triangles.
DistanceBounds farthest_distance(const Mesh& from, const Mesh& to,
                                 const HausdorffOptions& options = {});

// The larger of both ways.
DistanceBounds hausdorff_distance(const Mesh& a, const Mesh& b,
                                  const HausdorffOptions& options = {});

}  // namespace scan
