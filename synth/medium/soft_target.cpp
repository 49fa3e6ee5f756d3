// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/medium/soft_target.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "libscan/core/units.h"
#include "synth/medium/quadrature.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// The share of a normal variable beyond this many sigmas is 4e-15.
constexpr double reach_sigmas = 7.8;

// Share of the normal distribution between two places, without cancellation in its tails.
double normal_share(double from, double to) {
  const auto beyond = [](double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); };
  return from > 0 ? beyond(from) - beyond(to) : beyond(-to) - beyond(-from);
}

// Electrons per metre of range.
double return_per_m(const SoftTarget& t, double range_m) {
  return pi * t.backscatter_per_m_sr * t.white_electrons_at_1m *
         std::exp(-2 * t.extinction_per_m * range_m) / (range_m * range_m);
}

// Over panels that grow with the range and stay below `widest_m`, with Gauss and Legendre's rule of
// 10 nodes. 1 / R^2 over a panel of half its range has a remainder of 1e-12; a Gaussian over one
// sigma, or exp(-x) over one unit of x, less.
template <class Share>
double integrate(const SoftTarget& t, double from_m, double to_m, double widest_m, Share&& share) {
  static const std::vector<QuadratureNode> rule = gauss_legendre(10);
  double sum = 0;
  while (from_m < to_m) {
    const double width_m = std::min({to_m - from_m, widest_m, from_m / 2});
    for (const QuadratureNode& node : rule) {
      const double range_m = from_m + node.x * width_m;
      sum += node.weight * width_m * return_per_m(t, range_m) * share(range_m);
    }
    from_m = width_m == to_m - from_m ? to_m : from_m + width_m;
  }
  return sum;
}

}  // namespace

SoftTarget soft_target(const Medium& medium, double white_electrons_at_1m, double near_m) {
  return {.white_electrons_at_1m = white_electrons_at_1m,
          .backscatter_per_m_sr = medium.scattering_per_m * phase_value(medium.phase, -1),
          .extinction_per_m = extinction_per_m(medium),
          .near_m = near_m};
}

double soft_target_electrons(const SoftTarget& t, double far_m, double pulse_sigma_s,
                             double begin_s, double end_s) {
  if (t.backscatter_per_m_sr == 0) return 0;
  const double half_c = speed_of_light_m_s / 2;
  const double reach_s = reach_sigmas * pulse_sigma_s;
  const double from_m = std::max(t.near_m, half_c * (begin_s - reach_s));
  const double to_m = std::min(far_m, half_c * (end_s + reach_s));
  const double widest_m = std::min(half_c * pulse_sigma_s, 0.5 / t.extinction_per_m);
  return integrate(t, from_m, to_m, widest_m, [&](double range_m) {
    const double delay_s = range_m / half_c;
    return normal_share((begin_s - delay_s) / pulse_sigma_s, (end_s - delay_s) / pulse_sigma_s);
  });
}

// The integral of exp(-2 a R) / R^2 is -exp(-2 a R) / R + 2 a E1(2 a R), E1(x) = -Ei(-x).
double soft_target_total(const SoftTarget& t, double far_m) {
  if (!(far_m > t.near_m)) return 0;
  const double rate = 2 * t.extinction_per_m;
  const auto beyond = [&](double range_m) {
    if (std::isinf(range_m)) return 0.0;
    const double x = rate * range_m;
    return std::exp(-x) / range_m + (x > 0 ? rate * std::expint(-x) : 0);
  };
  return pi * t.backscatter_per_m_sr * t.white_electrons_at_1m * (beyond(t.near_m) - beyond(far_m));
}

}  // namespace scan::synth
