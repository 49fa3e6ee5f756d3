// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Two surfaces inside one pixel or one footprint: what physics says comes back.
#include <array>
#include <map>

#include "libscan/core/units.h"
#include "tests/synth/scanner_scenes.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

// A pixel so narrow that all its rays are equally long, three quarters of it on a near plate at 1
// m, the rest on a plane further away that returns `ratio` of the plate's amplitude.
double mixing_bias_m(double frequency_hz, double extra_m, double ratio) {
  PhaseCamera s;
  s.camera = {.width_px = 1, .height_px = 1, .fx_px = 1e6, .fy_px = 1e6};
  s.frequencies_hz = {frequency_hz};
  s.sub_rays = 4;
  const double far_m = 1 + extra_m, near_albedo = 0.3;
  const Scene scene{
      .objects = {plate(1, -0.1, 0.25 / 1e6), plane_at(far_m, 0, 1)},
      .materials = {plain(near_albedo), plain(near_albedo * ratio * 3 * far_m * far_m)}};
  const auto amplitude =
      expected_phasors(s, RayCaster(scene), Pose::Identity(), 0, 0).amplitude_e[0];
  const double per_m = 4 * std::numbers::pi * frequency_hz / speed_of_light_m_s;
  return std::arg(amplitude * std::polar(1.0, -per_m)) / per_m;
}

// bias = (c / 4 pi f) atan2(a sin psi, 1 + a cos psi), psi = 4 pi f extra / c, for a = 0.2: golden
// values in mm, each rounded to 0.01 mm. Beyond half a period of psi the bias changes its sign.
TEST(MixedPixel, HasTheBiasOfTwoPhasors) {
  const double extra_m[] = {0.05, 0.1, 0.25, 0.5, 1.0};
  const std::map<double, std::array<double, 5>> bias_mm = {
      {16e6, {8.33, 16.66, 41.56, 82.46, 159.62}},
      {80e6, {8.31, 16.49, 38.89, 59.77, -15.57}},
      {120e6, {8.28, 16.27, 35.26, 27.64, -35.18}}};
  for (const auto& [frequency_hz, golden] : bias_mm)
    for (std::size_t i = 0; i < golden.size(); ++i)
      EXPECT_NEAR(mixing_bias_m(frequency_hz, extra_m[i], 0.2), golden[i] * 1e-3, 6e-6)
          << frequency_hz << " Hz, " << extra_m[i] << " m";
}

// Half of the footprint on a near plate, half on a plane `extra_m` behind: the first range decoded,
// if any.
std::optional<double> first_range_m(double extra_m) {
  PulsedLidar s;
  s.pattern = RasterPattern{.rows = 1, .columns = 1, .height_rad = 0, .width_rad = 0};
  s.divergence_rad = 1e-3;
  s.sub_rays = 16;
  s.sensor = {.gain_e_per_dn = 4, .offset_dn = 8, .bits = 10};
  s.max_range_m = 30;
  const Scene scene{.objects = {plane_at(10 + extra_m), plate(10, 0, 1)},
                    .materials = {plain(0.5)}};
  const Scan scan = acquire(render(s, RayCaster(scene), Pose::Identity(), {}, no_effects).frames);
  if (scan.cloud.empty()) return std::nullopt;
  return scan.cloud.points[0].norm();
}

// Surfaces closer than the pulse (c sigma = 0.45 m): one return at the mean, weighted by energy,
// here one half each to within 1 / 32 (a line through the footprint, see pulsed_lidar_test.cpp).
// The fit of one Gaussian to two differs from the mean by the third moment, (extra / c sigma)^2 of
// the separation. From four sigma of the pulse on, 0.9 m: the first return, to what sampling and
// rounding cost (lidar_range_test.cpp: 0.12 mm; 0.5 mm where a second Gaussian is fitted next to it
// and takes on some of the difference between recorded pulse and Gaussian).
TEST(MixedFootprint, IsOneReturnWithinThePulseAndTwoBeyond) {
  for (const double extra_m : {0.01, 0.03, 0.1})
    EXPECT_NEAR(first_range_m(extra_m).value(), 10 + extra_m / 2,
                extra_m * (1.0 / 32 + std::pow(extra_m / 0.45, 2)) + 1.2e-4);
  for (const double extra_m : {1.6, 2.0, 5.0})
    EXPECT_NEAR(first_range_m(extra_m).value(), 10, 1.2e-4);
  for (const double extra_m : {0.9, 0.95, 1.0, 1.05, 1.1, 1.3})
    EXPECT_NEAR(first_range_m(extra_m).value(), 10, 5e-4) << extra_m;
}

// In between there is a point, and it lies between the nearer surface and the mean.
TEST(MixedFootprint, NeverLeavesTheTwoSurfaces) {
  for (int i = 0; i < 30; ++i) {
    const double extra_m = 0.1 + 0.05 * i;
    const auto range_m = first_range_m(extra_m);
    ASSERT_TRUE(range_m) << extra_m;
    EXPECT_GT(*range_m, 10 - 5e-4) << extra_m;
    EXPECT_LT(*range_m, 10 + extra_m * (0.5 + 1.0 / 32)) << extra_m;
  }
}

}  // namespace
}  // namespace scan::synth
