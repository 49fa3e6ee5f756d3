// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libscan/acquire/pulse_time.h"

namespace scan::decoding {
namespace {

// Values of the samples that decide: the two about half height, the two about the top.
struct Points {
  std::array<int, 4> index;  // flank below, flank above, top, top + 1
  std::array<double, 4> value;
};

// The place where half the top's height is reached. With the width s known, the logarithms of two
// neighbouring samples fix the pulse: ln(f1 / f0) = (2 (c - x0) - 1) / (2 s^2).
double half_height_place(const Points& p, double s) {
  const double top_centre = p.index[2] + 0.5 + s * s * std::log(p.value[3] / p.value[2]);
  const double offset = p.index[2] - top_centre;
  const double log_half = std::log(p.value[2]) + offset * offset / (2 * s * s) - std::numbers::ln2;
  const double below = std::log(p.value[0]), above = std::log(p.value[1]);
  // ln f(x0 + q) = below + q (above - below) + q (1 - q) / (2 s^2), solved for q = 0..1.
  const double curvature = 1 / (2 * s * s);
  const double slope = above - below + curvature;
  const double root2 = slope * slope - 4 * curvature * (log_half - below);
  return p.index[0] + 2 * (log_half - below) / (slope + std::sqrt(std::max(root2, 0.0)));
}

// Standard deviation by first-order propagation; the derivatives by central differences, because
// samples may serve twice.
double place_sigma(const Points& points, double s, double background_variance_e2) {
  double variance = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::find(points.index.begin(), points.index.begin() + i, points.index[i]) !=
        points.index.begin() + i)
      continue;
    const double change = 1e-4 * points.value[i];
    Points more = points, less = points;
    for (std::size_t j = 0; j < 4; ++j) {
      if (points.index[j] != points.index[i]) continue;
      more.value[j] += change;
      less.value[j] -= change;
    }
    const double slope = (half_height_place(more, s) - half_height_place(less, s)) / (2 * change);
    variance += slope * slope * (background_variance_e2 + points.value[i]);
  }
  return std::sqrt(variance);
}

}  // namespace

std::optional<Location> leading_edge(const Samples& samples, const Gaussian& start) {
  const std::span<const double> signal_e = samples.signal_e;
  const int count = static_cast<int>(signal_e.size());
  const int middle = std::clamp(static_cast<int>(std::floor(start.centre - samples.first)), 0,
                                std::max(count - 2, 0));
  if (count < 3) return std::nullopt;
  // The height is the fitted one; the flank is searched downwards from the top.
  int below = middle;
  while (below > 0 && signal_e[below] > start.amplitude / 2) --below;
  if (signal_e[below] > start.amplitude / 2) return std::nullopt;
  if (below + 1 >= count) return std::nullopt;
  const Points points{
      {below, below + 1, middle, middle + 1},
      {signal_e[below], signal_e[below + 1], signal_e[middle], signal_e[middle + 1]}};
  if (!std::all_of(points.value.begin(), points.value.end(), [](double v) { return v > 0; }))
    return std::nullopt;
  const double s = start.sigma;
  const double place =
      samples.first + half_height_place(points, s) + s * std::sqrt(2 * std::numbers::ln2);
  const double sigma = place_sigma(points, s, samples.background_variance_e2);
  if (!std::isfinite(place) || !std::isfinite(sigma)) return std::nullopt;
  return Location{{place, s, start.amplitude}, sigma};
}

}  // namespace scan::decoding
