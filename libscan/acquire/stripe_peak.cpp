// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_peak.h"

#include <algorithm>
#include <cmath>

#include "libscan/acquire/reason.h"

namespace scan::decoding {
namespace {

// The columns of the stripe within 3 sigma of its centre, at least two on each side.
struct Window {
  int first = 0;
  int last = 0;
  friend bool operator==(const Window&, const Window&) = default;
};

Window window_of(const Stripe& stripe, const Gaussian& shape) {
  const double reach = std::max(3 * shape.sigma, 2.0);
  return {std::max(stripe.first, static_cast<int>(std::floor(shape.centre - reach))),
          std::min(stripe.last, static_cast<int>(std::ceil(shape.centre + reach)))};
}

Samples samples_in(std::span<const double> signal_e, const Stripe& stripe, const Window& window) {
  return {signal_e.subspan(window.first, window.last - window.first + 1),
          static_cast<double>(window.first), stripe.background.variance_e2};
}

// Fit and window in turn, until the window that the fit asks for is the one it had.
std::optional<Location> fit_stripe(std::span<const double> signal_e, const Stripe& stripe) {
  Window window = window_of(stripe, stripe.shape);
  std::optional<Location> fit =
      fit_gaussian(samples_in(signal_e, stripe, window), stripe.shape, Width::free);
  for (int round = 0; fit && round < 8; ++round) {
    const Window wanted = window_of(stripe, fit->shape);
    if (wanted == window) break;
    window = wanted;
    fit = fit_gaussian(samples_in(signal_e, stripe, window), fit->shape, Width::free);
  }
  return fit;
}

// Whether the samples deviate from the fitted Gaussian by more than `max_shape_error` of its height
// and noise together. The noise part is the mean variance, uncertain by sqrt(2 sum v^2) / n; three
// sigma.
bool is_misshapen(const Samples& samples, const Gaussian& shape, double max_shape_error) {
  double excess = 0, variance2 = 0;
  for (std::size_t i = 0; i < samples.signal_e.size(); ++i) {
    const double u = (samples.first + static_cast<double>(i) - shape.centre) / shape.sigma;
    const double model = shape.amplitude * std::exp(-u * u / 2);
    const double variance = samples.background_variance_e2 + model;
    const double residual = samples.signal_e[i] - model;
    excess += residual * residual - variance;
    variance2 += variance * variance;
  }
  const double allowed = max_shape_error * shape.amplitude;
  return excess > allowed * allowed * static_cast<double>(samples.signal_e.size()) +
                      3 * std::sqrt(2 * variance2);
}

// Zero crossing of the antisymmetric difference filter g(i) = sum_k f(i + k) - f(i - k), k = 1..h
// (Blais and Rioux, Signal Processing 11, 1986; there h = 1, 2 or 4). Here h follows the stripe,
// two sigma, which is near the best for shot noise. Between two columns g is taken as straight,
// that is the stripe's top as a parabola.
std::optional<Location> parabola(std::span<const double> signal_e, const Stripe& stripe,
                                 const Gaussian& shape) {
  const int half = std::max(1, static_cast<int>(std::lround(2 * shape.sigma)));
  const int count = static_cast<int>(signal_e.size());
  const auto filter = [&](int i, auto&& term) {
    double sum = 0;
    for (int k = 1; k <= half; ++k) sum += term(i + k, +1.0) + term(i - k, -1.0);
    return sum;
  };
  const auto value = [&](int x, double sign) { return sign * signal_e[x]; };
  const auto noise = [&](int x, double) {
    return stripe.background.variance_e2 + std::max(signal_e[x], 0.0);
  };
  // The crossing from positive to negative that is nearest to the first guess.
  const int guess = static_cast<int>(std::floor(shape.centre));
  for (int offset = 0; offset <= half + 1; ++offset) {
    for (const int i : {guess + offset, guess - offset}) {
      if (i - half < 0 || i + 1 + half >= count) continue;
      const double here = filter(i, value), next = filter(i + 1, value);
      if (!(here >= 0 && next < 0)) continue;
      const double fraction = here / (here - next);
      const double spread = (1 - fraction) * filter(i, noise) + fraction * filter(i + 1, noise);
      return Location{{i + fraction, shape.sigma, shape.amplitude},
                      std::sqrt(spread) / (here - next)};
    }
  }
  return std::nullopt;
}

}  // namespace

StripePeak locate_stripe(std::span<const double> row_e, const Sensor& sensor,
                         const LaserLineOptions& options) {
  const Stripe stripe = find_stripe(row_e, sensor, options.threshold_sigmas);
  if (!stripe.miss.empty()) return {.miss = stripe.miss};
  std::vector<double> signal_e(row_e.begin(), row_e.end());
  for (double& value : signal_e) value -= stripe.background.level_e;

  // Every method takes its window from the fit, whose width has the least noise.
  std::optional<Location> peak = fit_stripe(signal_e, stripe);
  if (!peak) return {.miss = reason::ambiguous};
  const double reach = 3 * peak->shape.sigma;
  if (peak->shape.centre - reach < -0.5 || peak->shape.centre + reach > row_e.size() - 0.5)
    return {.miss = reason::border};
  if (is_misshapen(samples_in(signal_e, stripe, window_of(stripe, peak->shape)), peak->shape,
                   options.max_shape_error))
    return {.miss = reason::inconsistent};
  const double height_e = peak->shape.amplitude, width_px = peak->shape.sigma;
  if (options.peak == PeakMethod::centroid)
    peak = centroid(samples_in(signal_e, stripe, {stripe.first, stripe.last}), peak->shape);
  else if (options.peak == PeakMethod::parabola)
    peak = parabola(signal_e, stripe, peak->shape);
  if (!peak) return {.miss = reason::ambiguous};
  return {.column_px = peak->shape.centre,
          .sigma_px = peak->centre_sigma,
          .width_px = width_px,
          .height_e = height_e};
}

}  // namespace scan::decoding
