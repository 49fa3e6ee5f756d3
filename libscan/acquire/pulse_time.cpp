// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/pulse_time.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "libscan/acquire/gaussian_pair.h"
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

// Shot noise of the sum: sum of w^2 f, which for a pulse is about the sum of w f times 0.8.
double noise_e(const Correlation& correlation, const Background& background, double value_e) {
  return std::sqrt(correlation.weight2 * background.variance_e2 + value_e);
}

// A hump of the correlation: where it rises, its top (-1: none) and where it is over.
struct Hump {
  int begin = -1;
  int top = -1;
  int end = -1;
};

// What a search for humps compares: each ends where the correlation has fallen from its top by more
// than `sigmas` of its noise, or below the threshold.
struct Humps {
  const Correlation& correlation;
  const Background& background;
  double sigmas;
  double threshold_e;

  bool is_over(int top, int i) const {
    const double highest = correlation.sum_e[top], value = correlation.sum_e[i];
    return value < threshold_e ||
           highest - value > sigmas * noise_e(correlation, background, highest);
  }
  // The first above the threshold.
  Hump first() const;
  // The next before `limit`, which rises from the valley by more than `sigmas` of its noise.
  Hump next(const Hump& hump, int limit) const;
};

Hump Humps::first() const {
  const int count = static_cast<int>(correlation.sum_e.size());
  Hump hump;
  for (int i = 0; i < count; ++i) {
    if (hump.top < 0) {
      if (correlation.sum_e[i] >= threshold_e) hump.begin = hump.top = i;
      continue;
    }
    if (correlation.sum_e[i] > correlation.sum_e[hump.top]) hump.top = i;
    if (is_over(hump.top, i)) return {hump.begin, hump.top, i};
  }
  return {hump.begin, hump.top, count};
}

Hump Humps::next(const Hump& hump, int limit) const {
  const std::vector<double>& sum_e = correlation.sum_e;
  limit = std::min(limit, static_cast<int>(sum_e.size()));
  Hump found{.begin = hump.end, .top = -1, .end = limit};
  for (int i = hump.end; i < limit; ++i) {
    if (found.top < 0) {
      if (sum_e[i] < sum_e[found.begin]) found.begin = i;
      const double rise = sum_e[i] - sum_e[found.begin];
      if (sum_e[i] >= threshold_e && rise > sigmas * noise_e(correlation, background, sum_e[i]))
        found.top = i;
      continue;
    }
    if (sum_e[i] > sum_e[found.top]) found.top = i;
    if (is_over(found.top, i)) return {found.begin, found.top, i};
  }
  return found;
}

std::optional<Location> locate(PulseMethod method, const Samples& samples, const Gaussian& start) {
  // All methods start from the maximum-likelihood place.
  const std::optional<Location> fit = fit_gaussian(samples, start, Width::known);
  if (!fit || method == PulseMethod::matched_filter) return fit;
  if (method == PulseMethod::centroid) return centroid(samples, fit->shape);
  return leading_edge(samples, fit->shape);
}

// The first of two echoes that overlap: both are fitted; the other methods work on what the second
// leaves.
std::optional<Location> locate_first(PulseMethod method, const Samples& samples,
                                     const GaussianPair& start) {
  const std::optional<GaussianPair> pair = fit_gaussian_pair(samples, start);
  if (!pair) return std::nullopt;
  if (method == PulseMethod::matched_filter) return Location{pair->first, pair->first_sigma};
  const int reach = static_cast<int>(std::ceil(3 * start.first.sigma)) + 2;
  const int count = static_cast<int>(samples.signal_e.size());
  const int behind = static_cast<int>(std::lround(pair->first.centre - samples.first)) + reach + 1;
  std::vector<double> alone_e(samples.signal_e.begin(),
                              samples.signal_e.begin() + std::clamp(behind, 0, count));
  for (std::size_t i = 0; i < alone_e.size(); ++i) {
    const double u =
        (samples.first + static_cast<double>(i) - pair->second.centre) / pair->second.sigma;
    alone_e[i] -= pair->second.amplitude * std::exp(-u * u / 2);
  }
  return locate(method, {alone_e, samples.first, samples.background_variance_e2}, pair->first);
}

// The correlation's findings in the samples that it came from, less their background.
struct Finding {
  std::span<const double> readings_e;
  std::span<const double> signal_e;
  Humps humps;
  double pulse_sigma;
  double full_e;  // reading of a full sensor
  int reach;      // samples on either side of a top that tell its place

  Gaussian pulse_at(int place) const {
    const Correlation& correlation = humps.correlation;
    return {static_cast<double>(place), pulse_sigma,
            std::max(correlation.sum_e[place] / correlation.weight2, 1e-3)};
  }
  Samples samples(int first, int last) const {
    first = std::max(first, 0);
    last = std::min(last, static_cast<int>(signal_e.size()) - 1);
    return {signal_e.subspan(first, last - first + 1), static_cast<double>(first),
            humps.background.variance_e2};
  }
  double margin() const { return 2 * pulse_sigma; }  // to the record's ends
  bool is_inside(double place) const {
    return place >= margin() && place <= static_cast<double>(signal_e.size()) - 1 - margin();
  }
};

// Two equal pulses with the mass, mean and variance of the samples.
GaussianPair pair_by_moments(const Samples& samples, double pulse_sigma) {
  double mass = 0, mean = 0, square = 0;
  for (std::size_t i = 0; i < samples.signal_e.size(); ++i) {
    const double signal_e = std::max(samples.signal_e[i], 0.0);
    const double x = samples.first + static_cast<double>(i);
    mass += signal_e;
    mean += signal_e * x;
    square += signal_e * x * x;
  }
  mean /= mass;
  const double own = pulse_sigma * pulse_sigma;
  const double apart = std::sqrt(std::max(square / mass - mean * mean - own, own));
  const double height_e = mass / (2 * pulse_sigma * std::sqrt(2 * std::numbers::pi));
  return {{mean - apart, pulse_sigma, height_e}, {mean + apart, pulse_sigma, height_e}};
}

// The hump's echo, together with a second one that reaches into its samples. A hump that no single
// pulse fits is taken for two whose valley does not show.
std::optional<Location> locate(const WaveformOptions& options, const Finding& finding,
                               const Hump& hump) {
  const int first = hump.top - finding.reach;
  const int next = finding.humps.next(hump, hump.top + 2 * finding.reach).top;
  if (next >= 0)
    return locate_first(options.pulse, finding.samples(first, next + finding.reach),
                        {finding.pulse_at(hump.top), finding.pulse_at(next)});
  const auto alone = locate(options.pulse, finding.samples(first, hump.top + finding.reach),
                            finding.pulse_at(hump.top));
  if (alone) return alone;
  const Samples wide = finding.samples(first - finding.reach, hump.top + 2 * finding.reach);
  return locate_first(options.pulse, wide, pair_by_moments(wide, finding.pulse_sigma));
}

PulseTime measure(const WaveformOptions& options, const Finding& finding, const Hump& hump) {
  const int count = static_cast<int>(finding.signal_e.size());
  const auto begin = finding.readings_e.begin() + std::max(0, hump.top - finding.reach);
  const auto end = finding.readings_e.begin() + std::min(count, hump.top + finding.reach + 1);
  if (std::any_of(begin, end, [&](double value) { return value >= finding.full_e; }))
    return {.miss = reason::saturated};
  if (!finding.is_inside(hump.top)) return {.miss = reason::border};
  const std::optional<Location> pulse = locate(options, finding, hump);
  if (!pulse) return {.miss = reason::ambiguous};
  if (!finding.is_inside(pulse->shape.centre)) return {.miss = reason::border};
  return {.sample = pulse->shape.centre,
          .sigma_samples = pulse->centre_sigma,
          .height_e = pulse->shape.amplitude};
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
  const double sigmas = options.threshold_sigmas;
  const Finding finding{.readings_e = waveform_e,
                        .signal_e = signal_e,
                        .humps = {correlation, background, sigmas,
                                  background.threshold_e(sigmas, correlation.weight2)},
                        .pulse_sigma = pulse_sigma,
                        .full_e = full_e,
                        .reach = static_cast<int>(std::ceil(3 * pulse_sigma)) + 2};
  Hump hump = finding.humps.first();
  if (hump.top < 0) return {.miss = reason::no_signal};
  PulseTime pulse = measure(options, finding, hump);
  if (pulse.miss.empty() || hump.begin >= finding.margin()) return pulse;
  // The record begins on this hump: an echo cut off, or fog before the lens. The next may be whole.
  hump = finding.humps.next(hump, static_cast<int>(signal_e.size()));
  return hump.top < 0 ? pulse : measure(options, finding, hump);
}

}  // namespace scan::decoding
