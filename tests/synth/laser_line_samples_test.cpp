// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/laser_line_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "tests/synth/laser_bench.h"

namespace scan::synth {
namespace {

LaserLine moving_laser_with_lens(int sub_rays) {
  LaserLine s = small_laser();
  s.sub_rays = sub_rays;
  s.aperture_m = 4e-3;
  s.exposure_share = 0.5;
  return s;
}

// Expected electrons through all samples of a pixel.
double mean_electrons(const LaserView& view, int column, int row) {
  double sum = 0;
  const auto samples = camera_samples(view.scanner);
  for (const CameraSample& sample : samples)
    sum += view.after(sample.time_steps)
               .light(*camera_ray(view.scanner, {column, row}, sample))
               .laser_e;
  return sum / static_cast<double>(samples.size());
}

// Mean and variance of the stripe's place over a row.
struct Profile {
  double sum = 0;
  double mean_px = 0;
  double variance_px2 = 0;
};

Profile profile(const LaserView& view, int row) {
  Profile p;
  std::vector<double> e(view.scanner.camera.width_px);
  for (std::size_t i = 0; i < e.size(); ++i) {
    e[i] = mean_electrons(view, static_cast<int>(i), row);
    p.sum += e[i];
    p.mean_px += e[i] * static_cast<double>(i);
  }
  p.mean_px /= p.sum;
  for (std::size_t i = 0; i < e.size(); ++i)
    p.variance_px2 += e[i] / p.sum * std::pow(static_cast<double>(i) - p.mean_px, 2);
  return p;
}

TEST(CameraSamples, AreTheGridOfSubRaysForAPinholeAtRest) {
  LaserLine s = small_laser();
  ASSERT_EQ(camera_samples(s).size(), 1u);
  EXPECT_EQ(camera_samples(s)[0].place_px, Eigen::Vector2d(0, 0));
  s.sub_rays = 2;
  ASSERT_EQ(camera_samples(s).size(), 4u);
  for (const CameraSample& sample : camera_samples(s)) {
    EXPECT_EQ(sample.place_px.cwiseAbs(), Eigen::Vector2d(0.25, 0.25));
    EXPECT_EQ(sample.lens_m, Eigen::Vector2d(0, 0));
    EXPECT_EQ(sample.time_steps, 0);
  }
}

// A mean place, lens point or time other than zero would shift every stripe.
TEST(CameraSamples, AreClosedUnderChangeOfSign) {
  for (const int sub_rays : {1, 5, 6}) {
    const auto samples = camera_samples(moving_laser_with_lens(sub_rays));
    const std::size_t n = sub_rays == 6 ? 7 : 5;
    ASSERT_EQ(samples.size(), n * n);
    for (const CameraSample& a : samples) {
      int mirrored = 0;
      for (const CameraSample& b : samples)
        mirrored += (a.place_px + b.place_px).norm() < 1e-12 &&
                    (a.lens_m + b.lens_m).norm() < 1e-12 &&
                    std::abs(a.time_steps + b.time_steps) < 1e-12;
      EXPECT_EQ(mirrored, 1);
    }
  }
}

// Two coordinates: each cell of the n x n grid is met once.
TEST(CameraSamples, FillPlaceAndTimeEvenly) {
  const auto samples = camera_samples(moving_laser_with_lens(7));
  std::set<std::pair<int, int>> columns, rows;
  std::set<double> times;
  for (const CameraSample& sample : samples) {
    const int time = static_cast<int>(std::floor((sample.time_steps / 0.5 + 0.5) * 7));
    columns.emplace(std::lround(sample.place_px.x() * 7), time);
    rows.emplace(std::lround(sample.place_px.y() * 7), time);
    times.insert(sample.time_steps);
    EXPECT_LT(std::abs(sample.time_steps), 0.25);
  }
  EXPECT_EQ(columns.size(), 49u);
  EXPECT_EQ(rows.size(), 49u);
  EXPECT_EQ(times.size(), 49u);
}

// A disk of radius R: mean square of each coordinate R^2 / 4, of both R^2 / 2. Levels of n^2 steps
// leave 1 / n^4 of it, their pairing 1 / n^2: 4 %.
TEST(CameraSamples, FillTheLensEvenly) {
  double x2 = 0, y2 = 0, xy = 0, count = 0;
  for (const CameraSample& sample : camera_samples(moving_laser_with_lens(5))) {
    EXPECT_LE(sample.lens_m.norm(), 2e-3);
    x2 += sample.lens_m.x() * sample.lens_m.x();
    y2 += sample.lens_m.y() * sample.lens_m.y();
    xy += sample.lens_m.x() * sample.lens_m.y();
    ++count;
  }
  EXPECT_NEAR(x2 / count / 1e-6, 1, 0.04);
  EXPECT_NEAR(y2 / count / 1e-6, 1, 0.04);
  EXPECT_NEAR(xy / count / 1e-6, 0, 0.04);
}

// Thin lens: a point at depth z is a disk of radius f D / 2 |1 / z - 1 / z_f| px, of variance R^2 /
// 4 along the row; 4 % as above. Sharp at its focus.
TEST(Defocus, BlursByTheCircleOfConfusion) {
  LaserLine s = small_laser();
  s.beam_radius_m = 2e-3;
  s.aperture_m = 8e-3;
  const double z = focus_z(s);
  const auto variance = [&](double lens_focus_m, double aperture_m) {
    LaserLine device = s;
    device.lens_focus_m = lens_focus_m;
    device.aperture_m = aperture_m;
    const Bench bench(device, white_scene({plane_at(z)}));
    return profile(bench.view, 60).variance_px2;
  };
  const double sharp = variance(z, 0);
  EXPECT_NEAR(variance(z, 8e-3), sharp, 1e-6 * sharp) << "at the focus";
  for (const double focus_m : {0.7 * z, 1.5 * z}) {
    const double radius_px = 300 * 4e-3 * std::abs(1 / z - 1 / focus_m);
    LaserLine device = s;
    device.lens_focus_m = focus_m;
    EXPECT_NEAR(blur_radius_px(device, z), radius_px, 1e-12);
    EXPECT_NEAR(variance(focus_m, 8e-3) - sharp, radius_px * radius_px / 4,
                0.04 * radius_px * radius_px / 4)
        << focus_m;
  }
}

// An edge just through the view's central ray hides half the lens.
TEST(Defocus, SeesHalfTheLightPastAnEdge) {
  LaserLine s = small_laser();
  s.aperture_m = 4e-3;
  s.camera.cx_px = 80;
  s.camera.cy_px = 60;
  const double z = focus_z(s);
  const Bench free(s, white_scene({plane_at(z)}));
  const Bench hidden(s, white_scene({plane_at(z), plate(z / 2, -0.02, 0)}));
  const double all = mean_electrons(free.view, 80, 60);
  // one column of five of the array lies on the edge
  EXPECT_NEAR(mean_electrons(hidden.view, 80, 60) / all, 0.5, 0.1 + 1e-9);
  EXPECT_GT(all, 0.9 * s.peak_electrons);
}

// The stage carries the head towards the plane: the stripe at x = b - z tan(theta) moves by f b /
// z^2 px per metre, evenly in time, which adds 1 / 12 of the square to its variance (25 times: less
// 1 / 625).
TEST(Motion, SmearsTheStripeByItsWayDuringTheExposure) {
  LaserLine s = small_laser();
  s.beam_radius_m = 2e-3;
  s.stage_direction = {0, 0, 1};
  s.step_m = 8e-3;
  const double z = focus_z(s);
  const auto found = [&](double share) {
    LaserLine device = s;
    device.exposure_share = share;
    return profile(Bench(device, white_scene({plane_at(z)})).view, 60);
  };
  const Profile still = found(0), moving = found(0.6);
  const double way_px = 300 * s.baseline_m / (z * z) * 0.6 * 8e-3;
  ASSERT_GT(way_px, 3);
  // second order: (way / z)^2 / 12 of what is measured
  EXPECT_NEAR(moving.variance_px2 - still.variance_px2, way_px * way_px / 12,
              0.01 * way_px * way_px / 12 + 2e-3 * still.variance_px2);
  EXPECT_NEAR(moving.mean_px, still.mean_px, 0.01 * way_px);
}

// The traced band holds all light with lens, motion, spread and bow, at edges and limbs too.
TEST(LaserImages, MissNoLightOfARealDeviceOutsideTheTracedBand) {
  LaserLine s = moving_laser_with_lens(5);
  s.beam_radius_m = 2e-4;
  s.wavelength_m = 650e-9;
  s.beam_quality = 20;
  s.plane_bow_m = 1e-3;
  s.lens_focus_m = 0.25;
  s.aperture_m = 0.02;
  s.stage_direction = {0.3, 0.1, 1};
  s.step_m = 3e-3;
  for (const Object& object : {sphere_at({0.005, 0.01, 0.17}, 0.03), plate(0.15, -0.002, 0.02)}) {
    const Bench bench(s, white_scene({object, plane_at(0.35)}));
    const Image<std::uint8_t> band = lit_band(bench.view);
    int lit = 0, outside = 0;
    for (int row = 2; row < 120; row += 4)
      for (int column = 0; column < 160; ++column) {
        const bool is_lit = mean_electrons(bench.view, column, row) > 0.01;
        lit += is_lit;
        outside += is_lit && !band(column, row);
      }
    EXPECT_GT(lit, 60) << object.name;
    EXPECT_EQ(outside, 0) << object.name;
  }
}

}  // namespace
}  // namespace scan::synth
