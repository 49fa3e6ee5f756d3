// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How strongly a residual counts.
#pragma once

#include <cmath>

namespace scan {

// Tukey's biweight (Beaton and Tukey 1974): quadratic near zero, constant beyond `limit_m`.
// rho(r) = c^2/6 (1 - (1 - r^2/c^2)^3), weight = rho'(r) / r = (1 - r^2/c^2)^2.
struct TukeyLoss {
  double limit_m = 1;

  double rho_m2(double residual_m) const {
    const double inside = inside_of(residual_m);
    return limit_m * limit_m / 6 * (1 - inside * inside * inside);
  }
  double weight(double residual_m) const {
    const double inside = inside_of(residual_m);
    return inside * inside;
  }

 private:
  double inside_of(double residual_m) const {
    const double ratio = residual_m / limit_m;
    return ratio * ratio < 1 ? 1 - ratio * ratio : 0;
  }
};

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

// The limit that keeps 95 % of the efficiency of least squares on normal noise, in units of its
// sigma (Holland and Welsch 1977), and the factor from a median of absolute residuals to sigma.
inline constexpr double tukey_limit_in_sigmas = 4.685;
inline constexpr double sigma_from_median = 1.4826;

}  // namespace scan
