// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rims of round bodies against circles, whose rims are known.
#include "libscan/acquire/stripe_rim.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/acquire/stripe_sweep.h"

namespace scan::decoding {
namespace {

constexpr double radius_m = 0.03, beam_m = 5e-4, between_rad = 0.5;

// A circle lit along z and seen from afar, from between_rad beside the light, a column each 1e-4 m.
// The light grazes it at the angle 0, at x = grazed_m, the sight at pi - between_rad.
LitPlace place_on_circle(double angle_rad, double grazed_m) {
  const Eigen::Vector3d x(grazed_m - radius_m * (1 - std::cos(angle_rad)), 0,
                          -radius_m * std::sin(angle_rad));
  const double columns_per_offset = std::sin(angle_rad + between_rad) / std::sin(angle_rad);
  return {.offset_m = x.x(),
          .column_px = 1e4 * radius_m * std::cos(angle_rad + between_rad),
          .width_px = 1e4 * beam_m * columns_per_offset,
          .point = x};
}

constexpr std::array rims_m = {-5e-4, 0.0, 4e-4, 1e-3};  // beyond the plane

// Places two, three and four widths before the plane. Their parabola leaves out the offset's third
// derivative along the circle, at most sin(c) / R^2, times a b c R^3 / 6 at the rim, which lies the
// angles a < b < c away; that its vertex is off counts in its square (0.04^2 / 2 R = 0.05 widths).
// The beam's width in columns is told by a chord, to 1 %.
TEST(WidthsToRim, AreThoseToWhereTheLightGrazes) {
  for (const double rim_m : rims_m)
    for (const double side : {1.0, -1.0}) {
      std::array<LitPlace, 3> inner;
      double remainder = radius_m / beam_m / 6;
      for (std::size_t i = 0; i < 3; ++i) {
        const double drop_m = rim_m + beam_m * static_cast<double>(2 + i);
        const double angle_rad = std::acos(1 - drop_m / radius_m);
        inner[i] = place_on_circle(angle_rad, rim_m);
        inner[i].offset_m *= side;
        remainder *= i == 2 ? angle_rad * std::sin(angle_rad) : angle_rad;
      }
      EXPECT_LT(remainder, 0.5);
      EXPECT_NEAR(widths_to_rim(inner), rim_m / beam_m, remainder + 0.07) << rim_m << " " << side;
    }
}

// Places 0.1, 0.15 and 0.2 before the rim. As columns, the third derivative, at most sin(0.2) /
// R^2, moves the vertex by (0.1 0.15 + 0.1 0.2 + 0.15 0.2) / 6 of it, 0.002 R, and with it the
// offset, which falls by sin(0.5) of that: 0.06 widths; the offset's own remainder is 0.1 0.15 0.2
// / 6 R or 0.03 widths, and the beam's width is right to 1 %.
TEST(WidthsToRim, AreThoseToWhereTheSightGrazes) {
  const double rim_rad = std::numbers::pi - between_rad;
  for (const double rim_m : rims_m) {
    const double grazed_m = -rim_m - place_on_circle(rim_rad, 0).offset_m;
    std::array<LitPlace, 3> inner;
    for (std::size_t i = 0; i < 3; ++i)
      inner[i] = place_on_circle(rim_rad - 0.1 - 0.05 * static_cast<double>(i), grazed_m);
    EXPECT_NEAR(widths_to_rim(inner), rim_m / beam_m, 0.11) << rim_m;
  }
}

// Going inward the light's rim lies behind, the sight's a fifth of the circle and more ahead.
TEST(WidthsToRim, AreManyOnAPlaneAndGoingInward) {
  std::array<LitPlace, 3> plane, inward;
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = 1e-3 * static_cast<double>(i + 1);
    plane[i] = {.offset_m = x, .column_px = 4e3 * x, .width_px = 2, .point = {x, 0, 0}};
    inward[i] = place_on_circle(0.6 - 0.1 * static_cast<double>(i), 6e-3);
  }
  EXPECT_GT(widths_to_rim(plane), 1e9);
  EXPECT_GT(widths_to_rim(inward), 0.4 * radius_m / beam_m);
}

constexpr std::size_t first_step = 3;

// A cylinder of 0.4 m that the light of the first step meets so far from where it grazes it.
Sweep sweep_over_a_cylinder(double rim_m) {
  constexpr double cylinder_m = 0.4;
  constexpr std::size_t steps = 30;
  Sweep sweep = sweep_over_a_plane(steps);
  const Eigen::Vector3d normal = sweep.frames.calibration.plane_normal;
  const Eigen::Vector3d light(-normal.z(), 0, normal.x());
  const Eigen::Vector3d first = sweep.frames.scanner_from_camera[first_step].translation();
  for (std::size_t step = 0; step < steps; ++step) {
    const Eigen::Vector3d at = sweep.frames.scanner_from_camera[step].translation();
    const double from_rim_m = rim_m + normal.dot(at - first);
    const double along_m = std::sqrt(from_rim_m * (2 * cylinder_m - from_rim_m));
    LitRay& ray = sweep.rays[step];
    ray.point = at + Eigen::Vector3d(0, 0, 1) - (along_m + light.dot(at - first)) * light;
    ray.column_px = project(sweep.frames.calibration.camera, ray.point - at)->x();
    if (step < first_step) ray = {};
  }
  return sweep;
}

// A step is 8 mm along the light's normal and moves the place by five to six columns where the
// second to fourth step meet the cylinder (two of them the head's own way): a beam of 1.5 columns
// is 2 to 2.4 mm wide there. The rims are 0.04, 1.3 and 2.7 widths away, told to 0.3 as above.
TEST(StripeShift, OfAStripeBesideTheRimOfARoundBodyIsNotKnown) {
  for (const double rim_m : {1e-4, 3e-3}) {
    const Sweep sweep = sweep_over_a_cylinder(rim_m);
    EXPECT_FALSE(stripe_shift(sweep.frames, sweep.rays, first_step)) << rim_m;
  }
  const Sweep sweep = sweep_over_a_cylinder(6e-3);
  EXPECT_TRUE(stripe_shift(sweep.frames, sweep.rays, first_step));
}

}  // namespace
}  // namespace scan::decoding
