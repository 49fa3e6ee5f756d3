// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How speckle makes neighbouring pixels alike.
#pragma once

#include <cmath>
#include <numbers>

namespace scan::synth {

// Covariance of two pixels' mean factors, `lag_px` apart, for speckle of full contrast and the
// Gaussian pattern exp(-x^2 / a^2): Goodman's integral, by Simpson's rule.
inline double covariance_of_pixels(double grain_px, double lag_px) {
  const double a = 2 * grain_px / std::numbers::pi;
  constexpr int n = 2000;
  double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const double x = -1 + 2.0 * i / n;
    const double weight = i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * (1 - std::abs(x)) * std::exp(-(lag_px + x) * (lag_px + x) / (a * a));
  }
  return sum * 2 / n / 3;
}

}  // namespace scan::synth
