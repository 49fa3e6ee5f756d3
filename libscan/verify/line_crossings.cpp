// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/verify/line_crossings.h"

#include <algorithm>
#include <cmath>

namespace scan {
namespace {

// Newton steps of a point that is within a least step of the surface: two reach rounding and move
// it by no more than that.
SurfaceSample onto_surface(const PlacedShape& shape, Eigen::Vector3d x) {
  for (int step = 0; step < 2; ++step) {
    const DistanceField f = field(shape, x);
    x -= f.value_m / f.gradient.squaredNorm() * f.gradient;
  }
  return {x, field(shape, x).gradient.normalized(), 0};
}

}  // namespace

Ball ball_around(const Bounds& box) {
  return {box.center(), (0.5 + 1e-6) * box.diagonal().norm()};
}

// The field never exceeds the distance, so a step of its size cannot skip a surface; the least step
// passes through it, and misses only shorter chords.
void add_crossings(const PlacedShape& shape, const Line& line, double length_m,
                   std::vector<SurfaceSample>& crossings) {
  const double least_m = 5e-7 * length_m;
  double t = 0, value_m = field(shape, line.origin).value_m;
  while (t < length_m) {
    const double next = t + std::max(std::abs(value_m), least_m);
    const double next_m = field(shape, line.origin + next * line.direction).value_m;
    if ((value_m > 0) != (next_m > 0)) {
      const double zero = t + (next - t) * value_m / (value_m - next_m);  // secant
      crossings.push_back(onto_surface(shape, line.origin + zero * line.direction));
    }
    t = next;
    value_m = next_m;
  }
}

}  // namespace scan
