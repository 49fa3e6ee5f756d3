// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/pulse_time.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libscan/acquire/reason.h"

namespace scan::decoding {
namespace {

// Correlation with the pulse exp(-k^2 / 2 s^2), k within 3 s; samples outside the record are dark.
struct Correlation {
  std::vector<double> sum_e;
  double weight = 0;   // sum of the template
  double weight2 = 0;  // sum of its squares
};

Correlation correlate(std::span<const double> signal_e, double pulse_sigma) {
  const int count = static_cast<int>(signal_e.size());
  const int half = std::max(1, static_cast<int>(std::ceil(3 * pulse_sigma)));
  std::vector<double> pulse(2 * half + 1);
  Correlation correlation{std::vector<double>(signal_e.size()), 0, 0};
  for (int k = -half; k <= half; ++k) {
    const double weight = std::exp(-k * k / (2 * pulse_sigma * pulse_sigma));
    pulse[k + half] = weight;
    correlation.weight += weight;
    correlation.weight2 += weight * weight;
  }
  for (int i = 0; i < count; ++i)
    for (int k = std::max(-half, -i); k <= std::min(half, count - 1 - i); ++k)
      correlation.sum_e[i] += pulse[k + half] * signal_e[i + k];
  return correlation;
}

// Top of the first hump above the threshold; -1: none. The hump ends where the correlation has
// fallen from its top by more than threshold_sigmas of its noise, or below the threshold.
int first_top(const Correlation& correlation, const Background& background, double sigmas) {
  const double threshold = background.threshold_e(sigmas, correlation.weight2);
  int top = -1;
  for (int i = 0; i < static_cast<int>(correlation.sum_e.size()); ++i) {
    const double value = correlation.sum_e[i];
    if (top < 0) {
      if (value >= threshold) top = i;
      continue;
    }
    const double highest = correlation.sum_e[top];
    if (value > highest) top = i;
    // Shot noise of the sum: sum of w^2 f, which for a pulse is about the sum of w f times 0.8.
    const double noise = std::sqrt(correlation.weight2 * background.variance_e2 + highest);
    if (value < threshold || highest - value > sigmas * noise) break;
  }
  return top;
}

std::optional<Location> locate(PulseMethod method, const Samples& samples, const Gaussian& start) {
  // All methods start from the maximum-likelihood place.
  const std::optional<Location> fit = fit_gaussian(samples, start, Width::known);
  if (!fit || method == PulseMethod::matched_filter) return fit;
  if (method == PulseMethod::centroid) return centroid(samples, fit->shape);
  return leading_edge(samples, fit->shape);
}

}  // namespace

PulseTime locate_pulse(std::span<const double> waveform_e, double pulse_sigma, const Sensor& sensor,
                       const WaveformOptions& options) {
  const Background background = estimate_background(waveform_e, sensor);
  const double full_e = electrons(sensor, saturation_dn(sensor));
  if (background.level_e >= full_e) return {.miss = reason::saturated};
  std::vector<double> signal_e(waveform_e.begin(), waveform_e.end());
  for (double& value : signal_e) value -= background.level_e;

  const Correlation correlation = correlate(signal_e, pulse_sigma);
  const int top = first_top(correlation, background, options.threshold_sigmas);
  if (top < 0) return {.miss = reason::no_signal};
  const int count = static_cast<int>(signal_e.size());
  const int reach = static_cast<int>(std::ceil(3 * pulse_sigma)) + 2;
  const int first = std::max(0, top - reach), last = std::min(count - 1, top + reach);
  if (std::any_of(waveform_e.begin() + first, waveform_e.begin() + last + 1,
                  [&](double value) { return value >= full_e; }))
    return {.miss = reason::saturated};
  if (top < 2 * pulse_sigma || top > count - 1 - 2 * pulse_sigma) return {.miss = reason::border};

  const Samples samples{std::span(signal_e).subspan(first, last - first + 1),
                        static_cast<double>(first), background.variance_e2};
  const Gaussian start{static_cast<double>(top), pulse_sigma,
                       std::max(correlation.sum_e[top] / correlation.weight2, 1e-3)};
  const std::optional<Location> pulse = locate(options.pulse, samples, start);
  if (!pulse) return {.miss = reason::ambiguous};
  const double place = pulse->shape.centre;
  if (place < 2 * pulse_sigma || place > count - 1 - 2 * pulse_sigma)
    return {.miss = reason::border};
  return {
      .sample = place, .sigma_samples = pulse->centre_sigma, .height_e = pulse->shape.amplitude};
}

}  // namespace scan::decoding
