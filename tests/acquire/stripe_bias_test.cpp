// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The shift by form and brightness against the fit of a stripe that has them.
#include "libscan/acquire/stripe_bias.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "libscan/acquire/stripe_peak.h"
#include "tests/acquire/stripe_sweep.h"

namespace scan::decoding {
namespace {

// A body seen at u = a p + b p^2 whose brightness is 1 + g p, p in beam sigmas; a is the stripe's
// width in columns.
struct Body {
  double a, b, g;
  double column(double p) const { return 60 + a * p + b * p * p; }
  double offset(double column) const {
    const double u = column - 60;
    return 2 * u / (a + std::copysign(std::sqrt(a * a + 4 * b * u), a));
  }
  double brightness(double p) const { return 1 + g * p; }
  LitPlace place(double p) const { return {p, column(p), brightness(p)}; }
};

double fitted_shift_px(const Body& body) {
  std::vector<double> row_e;
  for (int column = 0; column < 121; ++column) {
    const double p = body.offset(column);
    row_e.push_back(std::isfinite(p) ? 3e4 * body.brightness(p) * std::exp(-p * p / 2) : 0);
  }
  return locate_stripe(row_e, {}, {}).column_px - 60;
}

// Terms of second order are left out: their share is the shift over the width, some 1 %, and the
// parabola through three places of a logarithm adds g^2 p^2 / 3 of g, 1 %. The fit looks three
// widths far, where the fourth moment is 0.94 of the whole: 6 % of the part of b.
TEST(StripeShift, IsThatOfTheBestFit) {
  for (const Body& body :
       {Body{6, 0, 0.02}, Body{6, 0.02, 0}, Body{6, -0.015, 0.02}, Body{-5, 0.02, -0.01}}) {
    const double expected = fitted_shift_px(body);
    EXPECT_GT(std::abs(expected), 0.02);
    EXPECT_NEAR(stripe_shift_px(body.place(0), body.place(-4), body.place(4), std::abs(body.a)),
                expected, 0.08 * std::abs(expected));
    EXPECT_NEAR(stripe_shift_px(body.place(0), body.place(4), body.place(8), std::abs(body.a)),
                expected, 0.1 * std::abs(expected));
  }
}

TEST(StripeShift, OfAnEvenFlatBodyIsNone) {
  const Body flat{6, 0, 0};
  EXPECT_NEAR(stripe_shift_px(flat.place(0), flat.place(-4), flat.place(5), 6), 0, 1e-13);
  EXPECT_EQ(stripe_shift_px(flat.place(0), flat.place(0), flat.place(5), 6), 0);
}

TEST(StripeShift, OfAPlaneIsNoneFromEndToEndOfTheSweep) {
  const Sweep sweep = sweep_over_a_plane(25);
  for (std::size_t ray = 0; ray < sweep.rays.size(); ++ray) {
    const StripeShift shift = stripe_shift(sweep.frames, sweep.rays, ray).value();
    EXPECT_TRUE(shift.is_known);
    EXPECT_NEAR(shift.shift_px, 0, 1e-9) << ray;
    EXPECT_EQ(shift.unknown_px, 0) << ray;
  }
}

// Four widths are three steps: a hole within them may have cut the stripe.
TEST(StripeShift, BesideAHoleIsThatOfACut) {
  Sweep sweep = sweep_over_a_plane(25);
  sweep.rays[12] = {};
  for (std::size_t ray = 0; ray < sweep.rays.size(); ++ray) {
    if (ray == 12) continue;
    const bool is_near = ray >= 9 && ray <= 15;
    EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, ray).value().unknown_px,
                is_near ? 0.15 * 1.5 : 0, 1e-9)
        << ray;
  }
}

// Four widths of 1.9 columns are four steps of two, three widths would be three.
TEST(StripeShift, LooksFourWidthsFar) {
  Sweep sweep = sweep_over_a_plane(25);
  for (LitRay& ray : sweep.rays) ray.width_px = 1.9;
  sweep.rays[12] = {};
  for (const std::size_t ray : {8u, 16u})
    EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, ray)->unknown_px, 0.15 * 1.9, 1e-9) << ray;
  for (const std::size_t ray : {7u, 17u})
    EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, ray)->unknown_px, 0, 1e-9) << ray;
}

// Brightness that grows by a tenth in its logarithm from step to step, two columns: half a tenth a
// column, times the width squared. At the sweep's ends two places on one side must tell it.
TEST(StripeShift, AtTheEndsOfTheSweepIsToldFromOneSide) {
  Sweep sweep = sweep_over_a_plane(25);
  for (std::size_t ray = 0; ray < sweep.rays.size(); ++ray)
    sweep.rays[ray].height_e = 1000 * std::exp(0.1 * static_cast<double>(ray));
  for (std::size_t ray = 0; ray < sweep.rays.size(); ++ray)
    EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, ray)->shift_px, 0.05 * 1.5 * 1.5, 1e-9)
        << ray;
}

// The last stripe before a hole is a place if it is as wide as those farther in, and none if the
// edge has taken a part of it.
TEST(StripeShift, OfACutStripeIsNotKnown) {
  Sweep sweep = sweep_over_a_plane(25);
  sweep.rays[12] = {};
  sweep.rays[11].width_px = 0.81 * 1.5;
  EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, 11).value().unknown_px, 0.15 * 0.81 * 1.5,
              1e-9);
  sweep.rays[11].width_px = 0.79 * 1.5;
  EXPECT_FALSE(stripe_shift(sweep.frames, sweep.rays, 11));
  sweep.rays[13].width_px = 0.79 * 1.5;
  EXPECT_FALSE(stripe_shift(sweep.frames, sweep.rays, 13));
}

// Nor is one a place that is as wide but has a third of the height, as beyond an edge.
TEST(StripeShift, OfATailBesideAHoleIsNotKnown) {
  Sweep sweep = sweep_over_a_plane(25);
  sweep.rays[12] = {};
  for (const std::size_t ray : {11u, 13u}) {
    sweep.rays[ray].height_e = 0.31 * 1000;
    EXPECT_TRUE(stripe_shift(sweep.frames, sweep.rays, ray)) << ray;
    sweep.rays[ray].height_e = 0.29 * 1000;
    EXPECT_FALSE(stripe_shift(sweep.frames, sweep.rays, ray)) << ray;
  }
}

// Stripes two columns apart of which each is 0.25 or 0.15 wide are 8 or 13 widths from each other.
TEST(StripeShift, OfStripesLaidFarApartIsNotJudgedByTheirHeights) {
  for (const double width_px : {0.25, 0.15}) {
    Sweep sweep = sweep_over_a_plane(25);
    for (LitRay& ray : sweep.rays) ray.width_px = width_px;
    sweep.rays[12] = {};
    sweep.rays[11].height_e = 0.29 * 1000;
    EXPECT_EQ(stripe_shift(sweep.frames, sweep.rays, 11).has_value(), width_px < 0.2) << width_px;
  }
}

// Where the plane of light goes past an edge to a body behind, its tail still lights the edge: of
// that stripe less is left than of those on either side, which are seen.
TEST(StripeShift, OfATailBetweenTwoBodiesIsNotKnown) {
  Sweep sweep = sweep_over_a_plane(25);
  sweep.rays[12].width_px = 0.79 * 1.5;
  EXPECT_FALSE(stripe_shift(sweep.frames, sweep.rays, 12));
  sweep.rays[12].width_px = 0.81 * 1.5;
  EXPECT_TRUE(stripe_shift(sweep.frames, sweep.rays, 12)->is_known);
  // as wide as the one, where the body is steeper on the other side
  for (std::size_t ray = 13; ray < 25; ++ray) sweep.rays[ray].width_px = 3;
  EXPECT_TRUE(stripe_shift(sweep.frames, sweep.rays, 12)->is_known);
}

TEST(StripeShift, OfALonelyStripeIsNotKnownUnlessItIsTheOnlyStep) {
  Sweep sweep = sweep_over_a_plane(25);
  for (const std::size_t ray : {10u, 11u, 13u, 14u}) sweep.rays[ray] = {};
  EXPECT_FALSE(stripe_shift(sweep.frames, sweep.rays, 12));
  const Sweep one = sweep_over_a_plane(1);
  EXPECT_NEAR(stripe_shift(one.frames, one.rays, 0).value().unknown_px, 0.15 * 1.5, 1e-9);
}

// Two looks at one place are no word of an edge, even if a third is missing to either side.
TEST(StripeShift, OfASweepThatStandsStillIsThatOfACut) {
  Sweep sweep = sweep_over_a_plane(5);
  for (auto& pose : sweep.frames.scanner_from_camera) pose = sweep.frames.scanner_from_camera[0];
  for (LitRay& ray : sweep.rays) ray.point = sweep.rays[0].point;
  sweep.rays[0] = sweep.rays[4] = {};
  EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, 2).value().unknown_px, 0.15 * 1.5, 1e-9);
}

// Of a step in brightness by b = ln 2 between two steps, the parabola's slope at the stripe tells.
TEST(StripeShift, GrowsWithTheBrightnessStep) {
  Sweep sweep = sweep_over_a_plane(25);
  for (std::size_t ray = 13; ray < 25; ++ray) sweep.rays[ray].height_e = 2000;
  // what is ahead is seen at higher columns: ln 2 / (2 * 6 columns) * (1.5 columns)^2
  EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, 12).value().shift_px,
              std::log(2.0) / 12 * 2.25, 1e-9);
  EXPECT_NEAR(stripe_shift(sweep.frames, sweep.rays, 2).value().shift_px, 0, 1e-9);
}

// Brightness that doubles between two steps as above, a quarter more of it from row to row: the
// mean over rows as far to either side is that of the middle one, whatever its own stripe says. Six
// rows, four widths, count; of 0.1 px in the sixth the mean of twelve has 3 (1.5 / 7)^2 / 2 / 12 or
// more, its places being 7 columns away on average: 5e-4 px.
TEST(StripeShifts, AreTheMeansOfTheRowsAround) {
  const std::size_t rows = 17, step = 12, ray = step * rows + 8;
  Sweep sweep = sweep_over_rows(25, rows);
  for (std::size_t i = 13 * rows; i < sweep.rays.size(); ++i)
    sweep.rays[i].height_e *= std::exp2(1 + 0.25 * (static_cast<double>(i % rows) - 8));
  const double expected_px = std::log(2.0) / 12 * 2.25;
  sweep.rays[ray].column_px += 0.1;
  const StripeShift shift = stripe_shifts(sweep.frames, sweep.rays)[ray].value();
  EXPECT_TRUE(shift.is_known);
  EXPECT_NEAR(shift.shift_px, expected_px, 1e-9);
  // Towards the step the logarithm rises by ln 2 over six columns and by no more over twelve: at
  // its foot by (4 - 1) ln 2 / 12 a column and not by ln 2 / 12. So much less or more may be true.
  EXPECT_NEAR(shift.unknown_px, 2 * expected_px, 1e-9);
  sweep.rays[ray - 6].column_px += 0.1;
  EXPECT_GT(std::abs(stripe_shifts(sweep.frames, sweep.rays)[ray]->shift_px - expected_px), 5e-4);
  std::swap(sweep.rays[ray - 6].column_px, sweep.rays[ray - 7].column_px);
  EXPECT_NEAR(stripe_shifts(sweep.frames, sweep.rays)[ray]->shift_px, expected_px, 1e-9);
}

// Brightness whose logarithm is a parabola of the place, as all three tell it: half a tenth a
// column in the middle. At the sweep's ends, where a place or the one beyond is missing, nobody
// asked says so.
TEST(StripeShifts, OfASmoothBodyAreKnownWhereFourPlacesTellThem) {
  const std::size_t rows = 5;
  Sweep sweep = sweep_over_rows(25, rows);
  for (std::size_t i = 0; i < sweep.rays.size(); ++i) {
    const double from_middle = static_cast<double>(i / rows) - 12;
    sweep.rays[i].height_e *= std::exp(0.1 * from_middle + 0.003 * from_middle * from_middle);
  }
  const auto shifts = stripe_shifts(sweep.frames, sweep.rays);
  for (std::size_t step = 0; step < 25; ++step) {
    const StripeShift shift = shifts[step * rows + 2].value();
    EXPECT_NEAR(shift.shift_px, (0.05 + 0.003 * (static_cast<double>(step) - 12)) * 1.5 * 1.5,
                1e-9);
    const bool is_checked = step >= 6 && step <= 18;
    EXPECT_NEAR(shift.unknown_px, is_checked ? 0 : std::abs(shift.shift_px), 1e-7) << step;
  }
}

// By central differences of the shift, to their third order and to what the slope u = a p changes
// by with the columns: the shift over its width, some 1 %.
TEST(ShiftSlopes, AreThoseOfTheShift) {
  const Body body{6, 0.02, 0.01};
  const std::array<LitPlace, 3> places = {body.place(0), body.place(-4), body.place(5)};
  const ShiftSlopes slopes = shift_slopes(places[0], places[1], places[2], 6);
  constexpr double step = 1e-4;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto shift_px = [&](double columns, double log_heights) {
      std::array<LitPlace, 3> moved = places;
      moved[i].column_px += columns;
      moved[i].height_e *= std::exp(log_heights);
      return stripe_shift_px(moved[0], moved[1], moved[2], 6);
    };
    EXPECT_NEAR((shift_px(step, 0) - shift_px(-step, 0)) / (2 * step), slopes.by_column[i], 5e-3);
    EXPECT_NEAR((shift_px(0, step) - shift_px(0, -step)) / (2 * step), slopes.by_log_height_px[i],
                1e-6);
  }
}

// Of a stripe that is broken off beside the row, and of the first row of an image, the own shift is
// all that there is: too noisy to move it.
TEST(StripeShifts, AreUnknownWhereTheStripeEnds) {
  const std::size_t rows = 9, ray = 12 * rows + 4;
  Sweep sweep = sweep_over_rows(25, rows);
  for (std::size_t i = 13 * rows; i < sweep.rays.size(); ++i) sweep.rays[i].height_e *= 2;
  const double own_px = std::log(2.0) / 12 * 2.25;
  const auto expect_unmoved = [&](std::size_t i) {
    const StripeShift shift = stripe_shifts(sweep.frames, sweep.rays)[i].value();
    EXPECT_EQ(shift.shift_px, 0);
    EXPECT_NEAR(shift.unknown_px, own_px, 1e-9);
  };
  expect_unmoved(12 * rows);
  sweep.rays[ray + 1].column_px += 1.6;  // more than a width of 1.5
  expect_unmoved(ray);
  sweep.rays[ray + 1] = {};
  expect_unmoved(ray);
}

}  // namespace
}  // namespace scan::decoding
