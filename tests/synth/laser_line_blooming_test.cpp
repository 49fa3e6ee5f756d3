// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_blooming.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/synth/laser_bench.h"

namespace scan::synth {
namespace {

constexpr double full_e = 100;

double sum(const std::vector<double>& row) {
  return std::accumulate(row.begin(), row.end(), 0.0);
}

// What one pixel cannot hold fills its neighbours, as many on each side.
TEST(Blooming, FillsPixelsOnBothSidesAlike) {
  std::vector<double> row(21, 0.0);
  row[10] = 7 * full_e;
  bloom(row, full_e, 1);
  for (int i = 0; i < 21; ++i) EXPECT_NEAR(row[i], std::abs(i - 10) <= 3 ? full_e : 0, 1e-10) << i;
  std::fill(row.begin(), row.end(), 0.0);
  row[10] = 6.5 * full_e;
  bloom(row, full_e, 1);
  EXPECT_NEAR(row[7], 0.75 * full_e, 1e-10) << "5 pixels full, the rest in halves";
  EXPECT_NEAR(row[13], 0.75 * full_e, 1e-10);
}

// Half the excess to each side, pixel by pixel, until none holds more than it can by 1e-10. The
// rest on its way, at most 1e-10 in each of n pixels, ends within n pixels: 1e-8 in all.
TEST(Blooming, EndsWherePixelByPixelSpillingEnds) {
  RandomStream random(5, 0, 0);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<double> row(40);
    for (double& e : row) {
      const double u = random.uniform();
      e = full_e * (u < 0.8 ? u : 6 * u);
    }
    std::vector<double> slow = row;
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t i = 0; i < slow.size(); ++i) {
        const double excess = slow[i] - full_e;
        if (!(excess > 1e-10)) continue;
        moved = true;
        slow[i] = full_e;
        if (i > 0) slow[i - 1] += excess / 2;
        if (i + 1 < slow.size()) slow[i + 1] += excess / 2;
      }
    }
    bloom(row, full_e, 1);
    for (std::size_t i = 0; i < row.size(); ++i) EXPECT_NEAR(row[i], slow[i], 1e-6) << i;
  }
}

TEST(Blooming, KeepsChargeAndCentreWithinTheRow) {
  std::vector<double> row(60, 10.0);
  row[25] = 900;
  row[31] = 400;
  const auto moment = [](const std::vector<double>& r) {
    double m = 0;
    for (std::size_t i = 0; i < r.size(); ++i) m += static_cast<double>(i) * r[i];
    return m;
  };
  const double charge = sum(row), centre = moment(row);
  bloom(row, full_e, 1);
  EXPECT_NEAR(sum(row), charge, 1e-9);
  EXPECT_NEAR(moment(row), centre, 1e-8);
  EXPECT_LE(*std::max_element(row.begin(), row.end()), full_e * (1 + 1e-12));
}

TEST(Blooming, LosesChargeOverTheEndsAndDownTheDrain) {
  std::vector<double> row = {500, 0, 0};
  bloom(row, full_e, 1);
  // Of 400 in excess at pixel 0, 200 leave and 200 reach pixel 1. Its excess of 100 wanders in two
  // full pixels: two thirds end at the right, one at the left (the gambler's ruin).
  EXPECT_NEAR(row[0], 100, 1e-10);
  EXPECT_NEAR(row[1], 100, 1e-10);
  EXPECT_NEAR(row[2], 200.0 / 3, 1e-10);
  row = {0, 500, 0};
  bloom(row, full_e, 0);
  EXPECT_EQ(row, (std::vector<double>{0, 100, 0}));
  row = {0, 300, 0};
  bloom(row, full_e, 0.5);
  EXPECT_EQ(row, (std::vector<double>{50, 100, 50}));
}

// In the image: four times the full well at its top, the stripe grows broader, its charge stays.
TEST(Blooming, KeepsAStripesChargeInTheImage) {
  LaserLine s = small_laser();
  s.beam_radius_m = 1e-3;
  s.sensor = {.gain_e_per_dn = 1, .full_well_e = 10000, .bits = 16};
  s.peak_electrons = 40000;
  s.blooming_share = 1;
  const RayCaster caster(white_scene({plane_at(focus_z(s))}));
  const auto charge = [&](const LaserLine& device, EffectSet effects) {
    const auto image = first_image(device, caster, effects);
    return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
  };
  LaserLine deep = s;
  deep.sensor.full_well_e = 1e9;
  const double all = charge(deep, noise_free), clipped = charge(s, noise_free);
  const double bloomed = charge(s, EffectSet(noise_free).set(Effect::blooming));
  EXPECT_LT(clipped, 0.7 * all);
  // half a step of rounding for each of the row's lit pixels
  EXPECT_NEAR(bloomed, all, 0.5 * 160 * 120 * 0.25);
}

}  // namespace
}  // namespace scan::synth
