// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How strongly a residual counts.
#pragma once

#include <cmath>

namespace scan {

// Welsch's (Dennis and Welsch 1978): quadratic near zero, s^2 far beyond the scale s.
// rho(r) = s^2 (1 - exp(-r^2 / 2 s^2)), weight = rho'(r) / r = exp(-r^2 / 2 s^2).
struct WelschLoss {
  double scale_m = 1;

  double rho_m2(double residual_m) const {
    return -scale_m * scale_m * std::expm1(power(residual_m));
  }
  double weight(double residual_m) const { return std::exp(power(residual_m)); }
  // rho''(r) = (1 - r^2 / s^2) weight(r).
  double curvature(double residual_m) const {
    return (1 + 2 * power(residual_m)) * weight(residual_m);
  }

 private:
  double power(double residual_m) const {
    const double ratio = residual_m / scale_m;
    return -0.5 * ratio * ratio;
  }
};

// From a median of absolute residuals to the sigma of normal noise.
inline constexpr double sigma_from_median = 1.4826;

}  // namespace scan
