// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Integrals of one variable, for the closed forms of light in media.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace scan::synth {

struct QuadratureNode {
  double x = 0;
  double weight = 0;
};

// Gauss and Legendre's rule on [0, 1]: exact for polynomials up to degree 2 count - 1.
std::vector<QuadratureNode> gauss_legendre(int count);

// Integral over [0, length] by the double exponential rule (Takahasi and Mori 1974), for functions
// that are smooth inside and may have an integrable singularity at either end; never evaluated at
// the ends themselves.
template <class Function>
double integrate_with_singular_ends(double length, Function&& function) {
  constexpr double step = 1.0 / 32;
  double sum = 0;
  for (int i = -120; i <= 120; ++i) {
    const double u = std::numbers::pi / 2 * std::sinh(i * step);
    const double from_end = 1 / (1 + std::exp(2 * std::abs(u)));  // in units of the length
    const double x = length * (u < 0 ? from_end : 1 - from_end);
    const double weight =
        std::numbers::pi * std::cosh(i * step) * from_end * (1 - from_end) * step * length;
    if (x > 0 && x < length) sum += weight * function(x);
  }
  return sum;
}

}  // namespace scan::synth
