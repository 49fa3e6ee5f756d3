// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/stripe_bias.h"

#include <algorithm>
#include <cmath>

#include "libscan/acquire/stripe_rim.h"
#include "libscan/acquire/stripe_walk.h"
#include "libscan/core/parallel.h"

namespace scan::decoding {
namespace {

// The farther the places, the less their own noise counts in the shift: at four widths a fifth of
// the centre's. Nearer ones would only measure noise.
constexpr double least_widths = 4;

// A stripe cut c widths from its centre passes the shape check from c = 0.8 on, where its fit
// stands 0.5 widths off; root mean square over all c up to four widths.
constexpr double cut_share = 0.15;

// A normal distribution cut c widths from its centre has the width 0.79 at c = 1, 0.60 at 0 and
// 0.45 if but the tail from one width on is left; its mean is off by 0.29, 0.80 and 1.53.
constexpr double whole_share = 0.8;

// A beam one and a half widths beyond an edge leaves 0.32 of its height on it.
constexpr double tail_share = 0.3;

// Places of stripes that are laid farther apart tell neither form nor brightness at this one.
constexpr double near_widths = 10;

}  // namespace

double stripe_shift_px(const LitPlace& here, const LitPlace& one, const LitPlace& other,
                       double width_px) {
  const double p1 = one.offset_m - here.offset_m, p2 = other.offset_m - here.offset_m;
  if (p1 == 0 || p2 == 0 || p1 == p2) return 0;
  const double slope1 = (one.column_px - here.column_px) / p1,
               slope2 = (other.column_px - here.column_px) / p2;
  const double b = (slope1 - slope2) / (p1 - p2), a = slope1 - b * p1;
  const double rise1 = std::log(one.height_e / here.height_e) / p1,
               rise2 = std::log(other.height_e / here.height_e) / p2;
  const double g = rise1 - (rise1 - rise2) / (p1 - p2) * p1;
  if (a == 0) return 0;
  return width_px * width_px * (g / a + 3 * b / (a * a));
}

ShiftSlopes shift_slopes(const LitPlace& here, const LitPlace& one, const LitPlace& other,
                         double width_px) {
  const double p1 = one.offset_m - here.offset_m, p2 = other.offset_m - here.offset_m;
  if (p1 == 0 || p2 == 0 || p1 == p2) return {};
  const double slope1 = (one.column_px - here.column_px) / p1,
               slope2 = (other.column_px - here.column_px) / p2;
  const double a = slope1 - (slope1 - slope2) / (p1 - p2) * p1;
  if (a == 0) return {};
  const double g = width_px * width_px / a, b = 3 * g / a;
  const double at_one = p1 * (p1 - p2), at_other = p2 * (p2 - p1);
  return {{b / (p1 * p2), b / at_one, b / at_other},
          {-g * (p1 + p2) / (p1 * p2), -g * p2 / at_one, -g * p1 / at_other}};
}

namespace {

// What three of five places tell: here, one, other, beyond one and beyond the other.
struct Parabola {
  double shift_px;
  std::array<double, 5> by_column = {}, by_log_height_px = {};

  Parabola(std::span<const LitPlace> places, std::size_t one, std::size_t other)
      : shift_px(stripe_shift_px(places[0], places[one], places[other], places[0].width_px)) {
    const ShiftSlopes slopes =
        shift_slopes(places[0], places[one], places[other], places[0].width_px);
    const std::array<std::size_t, 3> index = {0, one, other};
    for (std::size_t i = 0; i < 3; ++i) {
      by_column[index[i]] = slopes.by_column[i];
      by_log_height_px[index[i]] = slopes.by_log_height_px[i];
    }
  }
  Parabola operator-(const Parabola& less) const {
    Parabola rest = *this;
    rest.shift_px -= less.shift_px;
    for (std::size_t i = 0; i < 5; ++i) {
      rest.by_column[i] -= less.by_column[i];
      rest.by_log_height_px[i] -= less.by_log_height_px[i];
    }
    return rest;
  }
  // A Gaussian's height under shot noise is known to sqrt(3 / 2) times its centre's share of its
  // width (Cramer-Rao: 3 / (2 N) and 1 / N for N electrons), under even noise to sqrt(3) / 2.
  Told told(std::span<const LitPlace> places) const {
    Told told{shift_px, 0};
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double by_height = std::sqrt(1.5) * by_log_height_px[i] / places[i].width_px;
      told.variance_px2 += (by_column[i] * by_column[i] + by_height * by_height) *
                           places[i].sigma_px * places[i].sigma_px;
    }
    return told;
  }
};

// Of the places here, one and other; with those beyond, what parabolas on one side say.
StripeShift shift_of(std::span<const LitPlace> places) {
  const Parabola middle(places, 1, 2);
  const Told told = middle.told(places);
  StripeShift shift{told.value_px, 0, true, told.variance_px2};
  if (places.size() < 5) return shift;
  shift.departures = {(Parabola(places, 1, 3) - middle).told(places),
                      (Parabola(places, 2, 4) - middle).told(places)};
  return shift;
}

// Noise must not decide which of two steps, one at twice the distance, is the place beyond.
constexpr double beyond_share = 1.9;

// Places one and other on both sides, at `ahead` and `behind`, and those beyond at nearly twice
// their distance and more if the body is seen there.
StripeShift shift_between(const Walk& walk, const LitRay& here, const LitPlace& one, long ahead,
                          const LitPlace& other, long behind) {
  std::vector<LitPlace> places = {
      {0, here.column_px, here.height_e, here.width_px, here.sigma_px}, one, other};
  if (ahead > 0 && behind < 0) {
    const auto least_px = [&](const LitPlace& place) {
      return beyond_share * std::abs(place.column_px - here.column_px);
    };
    const auto beyond_one = walk.next(ahead, 1, least_px(one));
    const auto beyond_other = walk.next(behind, -1, least_px(other));
    if (beyond_one && beyond_other) places.insert(places.end(), {*beyond_one, *beyond_other});
  }
  return shift_of(places);
}

}  // namespace

std::optional<StripeShift> stripe_shift(const StripeImages& frames, std::span<const LitRay> rays,
                                        std::size_t ray) {
  const LitRay& here = rays[ray];
  const Walk walk(frames, rays, ray);
  const double least_px = least_widths * here.width_px;
  const StripeShift perhaps_cut{.unknown_px = cut_share * here.width_px};
  long ahead = 1, behind = -1;
  std::optional<LitPlace> one = walk.next(ahead, 1, least_px);
  std::optional<LitPlace> other = walk.next(behind, -1, least_px);
  // At either end of the sweep both places lie on the same side, the second twice as far.
  if (one && !other && !walk.is_step(behind)) other = walk.next(ahead, 1, 2 * least_px);
  if (other && !one && !walk.is_step(ahead)) one = walk.next(behind, -1, 2 * least_px);
  const bool is_swept = (walk.is_step(ahead) || walk.is_step(behind)) &&
                        std::max(walk.moves_px(1), walk.moves_px(-1)) > here.width_px;
  if (!one && !other) return is_swept ? std::nullopt : std::optional(perhaps_cut);
  if (!one || !other) {
    const LitPlace& inner = one ? *one : *other;
    if (here.width_px < whole_share * inner.width_px) return std::nullopt;
    const double apart_px = std::abs(inner.column_px - here.column_px);
    if (apart_px > near_widths * inner.width_px) return perhaps_cut;
    if (here.height_e < tail_share * inner.height_e) return std::nullopt;
    if (is_at_rim(walk, inner.width_px, one ? 1 : -1)) return std::nullopt;
    return perhaps_cut;
  }
  if (here.width_px < whole_share * std::min(one->width_px, other->width_px)) return std::nullopt;
  const StripeShift shift = shift_between(walk, here, *one, ahead, *other, behind);
  if (!std::isfinite(shift.shift_px)) return perhaps_cut;
  return shift;
}

namespace {

// The mean over rows at the same distance to either side.
struct Around {
  int count = 0;
  Told shift = {};
  std::optional<std::array<Told, 2>> departures = std::array<Told, 2>{};

  void add(const StripeShift& row) {
    ++count;
    shift.value_px += row.shift_px;
    shift.variance_px2 += row.variance_px2;
    if (!row.departures) departures.reset();
    for (std::size_t i = 0; departures && i < 2; ++i) {
      (*departures)[i].value_px += (*row.departures)[i].value_px;
      (*departures)[i].variance_px2 += (*row.departures)[i].variance_px2;
    }
  }
  Told mean_of(const Told& sum) const {
    return {sum.value_px / count, sum.variance_px2 / count / count};
  }
  StripeShift mean() const {
    const Told told = mean_of(shift);
    double misfit_px2 = told.value_px * told.value_px;
    if (departures) {
      misfit_px2 = 0;
      for (const Told& sum : *departures) {
        const Told departure = mean_of(sum);
        misfit_px2 =
            std::max(misfit_px2, departure.value_px * departure.value_px - departure.variance_px2);
      }
    }
    return {told.value_px, std::sqrt(misfit_px2 + told.variance_px2), true, told.variance_px2};
  }
};

Around around(std::span<const LitRay> rays, std::span<const std::optional<StripeShift>> own,
              std::size_t rows, std::size_t ray) {
  const auto goes_on = [&](std::size_t from, std::size_t to) {
    return own[to] && own[to]->is_known &&
           std::abs(rays[to].column_px - rays[from].column_px) < rays[ray].width_px;
  };
  const std::size_t row = ray % rows;
  const auto reach = static_cast<std::size_t>(least_widths * rays[ray].width_px);
  const std::size_t most = std::min({reach, row, rows - 1 - row});
  Around sum;
  for (std::size_t k = 1; k <= most; ++k) {
    if (!goes_on(ray - k + 1, ray - k) || !goes_on(ray + k - 1, ray + k)) break;
    sum.add(*own[ray - k]);
    sum.add(*own[ray + k]);
  }
  return sum;
}

}  // namespace

std::vector<std::optional<StripeShift>> stripe_shifts(const StripeImages& frames,
                                                      std::span<const LitRay> rays) {
  std::vector<std::optional<StripeShift>> own(rays.size());
  parallel_for(rays.size(), [&](std::size_t ray) {
    if (rays[ray].width_px > 0) own[ray] = stripe_shift(frames, rays, ray);
  });
  std::vector<std::optional<StripeShift>> shifts = own;
  const auto rows = static_cast<std::size_t>(frames.calibration.camera.height_px);
  parallel_for(rays.size(), [&](std::size_t ray) {
    if (!own[ray] || !own[ray]->is_known) return;
    const Around rows_around = around(rays, own, rows, ray);
    shifts[ray] = rows_around.count > 0 ? rows_around.mean()
                                        : StripeShift{0, std::abs(own[ray]->shift_px), false};
  });
  return shifts;
}

}  // namespace scan::decoding
