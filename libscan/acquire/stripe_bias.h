// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far a body's form and brightness move a stripe's centre: what a stripe cannot tell by itself,
// but those of the steps before and behind it can.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "libscan/acquire/stripe_walk.h"

namespace scan::decoding {

// The stripe lights the places with offsets p by exp(-p^2 / (2 w^2)). Let u = a p + b p^2 be the
// columns they are seen at and 1 + g p their brightness, by the parabolas through three places.
// With s = a w the image is exp(-u^2 / (2 s^2)) (1 + g u / a + b u^3 / (a^2 s^2)) to first order,
// and the Gaussian that fits it best under shot noise, as the centroid, stands off by the mean of
// that times u: s^2 (g / a + 3 b / a^2). `here` is the stripe's own place, s = width_px; 0 if two
// places coincide.
double stripe_shift_px(const LitPlace& here, const LitPlace& one, const LitPlace& other,
                       double width_px);

// Something the places of stripes tell, and what their noise does to it.
struct Told {
  double value_px = 0;
  double variance_px2 = 0;
};

// What form and brightness do to a stripe.
struct StripeShift {
  double shift_px = 0;    // of its centre by the formula above; 0 where it is not known
  double unknown_px = 0;  // one standard deviation of what else may have moved it, besides noise
  bool is_known = false;
  double variance_px2 = 0;  // of shift_px by the noise of the three places
  // By how much the parabolas through two places on one side differ from it, where there are such.
  std::optional<std::array<Told, 2>> departures = {};
};

// What the noise of three places does to their shift, to first order: its derivatives by their
// columns and by the logarithms of their heights, of `here`, `one` and `other` in turn (Lagrange's
// parabola).
struct ShiftSlopes {
  std::array<double, 3> by_column = {}, by_log_height_px = {};
};
ShiftSlopes shift_slopes(const LitPlace& here, const LitPlace& one, const LitPlace& other,
                         double width_px);

// Of `ray` (of step * rows + row), by places of the same row that are seen at least four widths
// away. Where the body is not seen that far to one side the stripe may be cut: then 0.15 widths are
// unknown, but none is returned if it has less than 0.8 of the width of the one on the other side,
// as one that is cut within a width of its centre, or beside it: then its place is the edge's and
// no longer the plane's. Nor if that one is less than ten widths away and it has less than 0.3 of
// its height, as the tail of a beam that is past the edge, or a round body's rim is near
// (is_at_rim). None as well if it has less than 0.8 of the width of either of two, whose mean a
// stripe that is whole has nearly: a tail on an edge that the plane of light has passed, another
// body behind. And none where steps a width and more apart see the body on neither side, so that it
// may be such a tail; where the sweep stands still, or has no other step, 0.15.
std::optional<StripeShift> stripe_shift(const StripeImages& frames, std::span<const LitRay> rays,
                                        std::size_t ray);

// That of each ray as the rays around it tell: the mean over those of its step up to four widths
// of rows away, as many to either side, as far as the stripe goes on (by less than a width from row
// to row) and is known; its own left out, since it holds the noise of the centre that is to be
// moved by it, three sixteenths. Unknown stays the noise of that mean, and what a parabola over
// four widths does not tell: on a smooth body those through two places on one side, the second
// twice as far, say nearly the same; with a crease or an edge of colour on one side the other's is
// right (Harten et al. 1987, essentially non-oscillatory interpolation). So the larger departure of
// the two counts, their mean over the same rows, less what noise makes of its square. Where the
// body is not seen so far, as much as the shift; without such rays its own is unknown altogether.
std::vector<std::optional<StripeShift>> stripe_shifts(const StripeImages& frames,
                                                      std::span<const LitRay> rays);

}  // namespace scan::decoding
