// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libscan/acquire/reason.h"

namespace scan::decoding {
namespace {

constexpr std::array box_widths_px = {1, 3, 5, 9, 17, 33};
constexpr double clear_sigmas = 8;   // of a peak over all its noise, shot noise included
constexpr double rival_share = 0.5;  // of the strongest peak's height that makes another a rival
constexpr double fwhm_per_sigma = 2.354820045030949;  // 2 sqrt(2 ln 2)

// Sums of the signal over a box around each pixel; the box is cut at the row's ends.
struct Smoothed {
  int width = 1;  // of the box, px
  std::vector<double> sum_e;
  int strongest = 0;
};

Smoothed smooth(std::span<const double> row_e, const Background& background, int width) {
  const int count = static_cast<int>(row_e.size()), half = width / 2;
  std::vector<double> running(row_e.size() + 1, 0);
  for (int i = 0; i < count; ++i) running[i + 1] = running[i] + row_e[i] - background.level_e;
  Smoothed smoothed{width, std::vector<double>(row_e.size()), 0};
  for (int i = 0; i < count; ++i)
    smoothed.sum_e[i] = running[std::min(i + half + 1, count)] - running[std::max(i - half, 0)];
  smoothed.strongest = static_cast<int>(
      std::max_element(smoothed.sum_e.begin(), smoothed.sum_e.end()) - smoothed.sum_e.begin());
  return smoothed;
}

double variance(const Smoothed& smoothed, const Background& background, double sum_e) {
  return smoothed.width * background.variance_e2 + std::max(sum_e, 0.0);
}

// The finest box whose peak is above the threshold and clear of its own noise; failing that, the
// clearest one above the threshold; none: width 0.
Smoothed best_box(std::span<const double> row_e, const Background& background, double sigmas) {
  Smoothed best{0, {}, 0};
  double best_clarity = 0;
  for (const int width : box_widths_px) {
    if (width > static_cast<int>(row_e.size())) break;
    Smoothed smoothed = smooth(row_e, background, width);
    const double peak = smoothed.sum_e[smoothed.strongest];
    if (!(peak >= background.threshold_e(sigmas, width))) continue;
    const double clarity = peak / std::sqrt(variance(smoothed, background, peak));
    if (clarity <= best_clarity) continue;
    best_clarity = clarity;
    best = std::move(smoothed);
    if (clarity >= clear_sigmas) break;
  }
  return best;
}

// One side of the peak, walked outwards.
struct Flank {
  double half_height = -1;  // column where the height has fallen to one half; -1: nowhere
  int valley = 0;           // last column that belongs to the peak
  bool rival = false;
};

Flank walk(const Smoothed& smoothed, const Background& background, double sigmas, int direction) {
  const int count = static_cast<int>(smoothed.sum_e.size());
  const double top = smoothed.sum_e[smoothed.strongest];
  Flank flank;
  flank.valley = direction > 0 ? count - 1 : 0;
  double lowest = top;
  int lowest_at = smoothed.strongest;
  bool risen = false;
  for (int x = smoothed.strongest + direction; x >= 0 && x < count; x += direction) {
    const double value = smoothed.sum_e[x], before = smoothed.sum_e[x - direction];
    if (flank.half_height < 0 && value <= top / 2)
      flank.half_height = x - direction * (top / 2 - value) / (before - value);
    if (value < lowest) {
      lowest = value;
      if (!risen) lowest_at = x;
      continue;
    }
    const double noise2 =
        variance(smoothed, background, value) + variance(smoothed, background, lowest);
    if (!(value - lowest > sigmas * std::sqrt(noise2))) continue;
    if (!risen) flank.valley = lowest_at;
    risen = true;
    if (value >= rival_share * top) flank.rival = true;
  }
  return flank;
}

}  // namespace

Stripe find_stripe(std::span<const double> row_e, const Sensor& sensor, double threshold_sigmas) {
  Stripe stripe;
  stripe.background = estimate_background(row_e, sensor);
  const double full_e = electrons(sensor, saturation_dn(sensor));
  if (stripe.background.level_e >= full_e) {
    stripe.miss = reason::saturated;
    return stripe;
  }
  const Smoothed smoothed = best_box(row_e, stripe.background, threshold_sigmas);
  if (smoothed.width == 0) {
    stripe.miss = reason::no_signal;
    return stripe;
  }
  const Flank left = walk(smoothed, stripe.background, threshold_sigmas, -1);
  const Flank right = walk(smoothed, stripe.background, threshold_sigmas, +1);
  const double low = left.half_height < 0 ? 0 : left.half_height;
  const double high = right.half_height < 0 ? row_e.size() - 1.0 : right.half_height;
  const bool clipped =
      std::any_of(row_e.begin() + static_cast<int>(low), row_e.begin() + static_cast<int>(high) + 1,
                  [&](double value) { return value >= full_e; });
  if (clipped)
    stripe.miss = reason::saturated;
  else if (left.rival || right.rival)
    stripe.miss = reason::ambiguous;
  else if (left.half_height < 0 || right.half_height < 0)
    stripe.miss = reason::border;
  // The box adds its own variance to the stripe's.
  const double fwhm = (high - low) / fwhm_per_sigma;
  const double variance_px2 = fwhm * fwhm - (smoothed.width * smoothed.width - 1) / 12.0;
  stripe.shape.sigma = std::sqrt(std::max(variance_px2, 0.25));
  stripe.shape.centre = (low + high) / 2;
  stripe.shape.amplitude = smoothed.sum_e[smoothed.strongest] / smoothed.width;
  stripe.first = left.valley;
  stripe.last = right.valley;
  return stripe;
}

}  // namespace scan::decoding
