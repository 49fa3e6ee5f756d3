// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_rim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scan::decoding {
namespace {

constexpr double whole_widths = 2;

// y over x through three places (Newton): slopes between neighbours, and half the second
// derivative.
struct Parabola {
  double x0, y0, x1, slope, bend;

  Parabola(const std::array<double, 3>& x, const std::array<double, 3>& y)
      : x0(x[0]), y0(y[0]), x1(x[1]), slope((y[1] - y[0]) / (x[1] - x[0])) {
    bend = ((y[2] - y[1]) / (x[2] - x[1]) - slope) / (x[2] - x[0]);
  }
  double x_of_vertex() const { return (x0 + x1 - slope / bend) / 2; }
  double at(double x) const { return y0 + (x - x0) * (slope + bend * (x - x1)); }
};

}  // namespace

double widths_to_rim(std::span<const LitPlace, 3> inner) {
  const double first_m = (inner[1].point - inner[0].point).norm(),
               second_m = (inner[2].point - inner[1].point).norm();
  const std::array along_m = {0.0, -first_m, -first_m - second_m};
  const Parabola offset_m(along_m, {inner[0].offset_m, inner[1].offset_m, inner[2].offset_m});
  const Parabola column_px(along_m, {inner[0].column_px, inner[1].column_px, inner[2].column_px});
  double rim_m = std::numeric_limits<double>::infinity();
  for (const double vertex_m : {offset_m.x_of_vertex(), column_px.x_of_vertex()})
    if (vertex_m > 0) rim_m = std::min(rim_m, vertex_m);
  const double beam_m = inner[1].width_px * std::abs((inner[2].offset_m - inner[0].offset_m) /
                                                     (inner[2].column_px - inner[0].column_px));
  const double outward = inner[0].offset_m < 0 ? 1 : -1;
  return std::isfinite(rim_m) ? outward * offset_m.at(rim_m) / beam_m : rim_m;
}

bool is_at_rim(const Walk& walk, double width_px, long direction) {
  std::array<LitPlace, 3> inner;
  long at = 0;
  for (std::size_t i = 0; i < inner.size(); ++i) {
    at += direction;
    const auto place = walk.next(at, direction, 2 * static_cast<double>(i + 1) * width_px);
    if (!place) return false;
    inner[i] = *place;
  }
  return widths_to_rim(inner) < whole_widths;
}

}  // namespace scan::decoding
