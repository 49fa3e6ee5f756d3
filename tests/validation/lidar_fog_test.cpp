// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The lidar in fog, from scene to waveform and points, against Beer, Lambert and the soft target.
#include <cmath>
#include <numbers>
#include <numeric>

#include "libscan/core/units.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

using std::numbers::pi;
constexpr double c = speed_of_light_m_s;

PulsedLidar lidar() {
  PulsedLidar s;
  s.pattern = RasterPattern{.rows = 1, .columns = 1, .height_rad = 0, .width_rad = 0};
  s.ambient_electrons = 0;
  s.electrons_at_10m = 5e4;
  s.max_range_m = 60;
  s.sensor = {.gain_e_per_dn = 1.0 / 16, .bits = 16};
  return s;
}

struct Record {
  std::vector<double> electrons;
  double start_s = 0, interval_s = 0;

  double time_s(std::size_t i) const { return start_s + static_cast<double>(i) * interval_s; }
  double sum(double from_m, double to_m) const {
    double total = 0;
    for (std::size_t i = 0; i < electrons.size(); ++i)
      if (time_s(i) * c / 2 >= from_m && time_s(i) * c / 2 < to_m) total += electrons[i];
    return total;
  }
};

Record record(const PulsedLidar& s, const Scene& scene) {
  const auto frames = std::get<Waveforms>(
      render(s, RayCaster(scene), Pose::Identity(), {}, {Effect::medium}).frames);
  Record result{{}, frames.calibration.window_start_s, frames.calibration.sample_interval_s};
  for (const std::uint16_t dn : frames.samples)
    result.electrons.push_back(dn * frames.calibration.sensor.gain_e_per_dn);
  return result;
}

// Physics 7.7: two-way transmission at 50 m is 0.0025, 0.0500, 0.2236, 0.549 for a meteorological
// optical range of 50, 100, 200, 500 m. Absorbing fog sends nothing back. Rounding by 1/64 e (64
// times finer steps do not fit 16 bits) in 30 samples of 5 e and more.
TEST(LidarInFog, SeesTheTargetByBeerAndLambert) {
  const double golden[][2] = {{50, 0.0025}, {100, 0.0500}, {200, 0.2236}, {500, 0.549}};
  for (const auto& [optical_range_m, transmission] : golden) {
    Scene scene{.objects = {plane_at(50)}, .materials = {plain(1)}};
    scene.medium = fog(optical_range_m, 0, 0);
    const double clear_e = 5e4 * 100 / 2500;
    const double seen = record(lidar(), scene).sum(45, 55) / clear_e;
    EXPECT_NEAR(seen, std::exp(-2 * std::log(20.0) / optical_range_m * 50), 30 / 32.0 / clear_e);
    EXPECT_NEAR(seen, transmission, 5e-4 + 30 / 32.0 / clear_e);
  }
}

// The soft target (Rasshofer et al. 2011; Hahner et al. 2021): at ranges far beyond the pulse the
// waveform is pi beta exp(-2 alpha R) E1 / R^2 c dt / 2 per sample, with beta = 0.046 / MOR for the
// phase function that has beta / alpha = 0.046 / ln(20) straight back. Second order in pulse over
// range: (3 / R^2 + 2 alpha^2) (c sigma / 2)^2 < 0.004 beyond 8 m. Rounding by 1/32 e.
TEST(LidarInFog, SeesTheSoftTarget) {
  const double optical_range_m = 100, alpha = std::log(20.0) / optical_range_m;
  // Isotropic: beta = albedo alpha / (4 pi): albedo 0.046 4 pi / ln(20) = 0.193.
  const double beta = 0.046 / optical_range_m;
  PulsedLidar s = lidar();
  s.electrons_at_10m = 5e5;
  s.overlap_m = 2;
  Scene scene;
  scene.medium = fog(optical_range_m, 0, 0.046 * 4 * pi / std::log(20.0));
  const Record seen = record(s, scene);
  for (std::size_t i = 0; i < seen.electrons.size(); ++i) {
    const double range_m = seen.time_s(i) * c / 2;
    if (range_m < 8 || range_m > 50) continue;
    const double expected_e = pi * beta * std::exp(-2 * alpha * range_m) * 5e7 /
                              (range_m * range_m) * c / 2 * s.sample_interval_s;
    EXPECT_NEAR(seen.electrons[i], expected_e, 0.006 * expected_e + 1 / 31.0) << range_m;
  }
}

// Mean and standard error over a scan's pulses of the electrons between two ranges.
struct Stretch {
  double mean = 0, error = 0;
};

Stretch stretch(const Waveforms& frames, double from_m, double to_m) {
  const auto rays = static_cast<double>(frames.directions.size());
  double sum = 0, square = 0;
  for (std::size_t ray = 0; ray < frames.directions.size(); ++ray) {
    double electrons = 0;
    for (std::uint32_t i = 0; i < frames.samples_per_ray; ++i) {
      const double range_m =
          c / 2 * (frames.calibration.window_start_s + i * frames.calibration.sample_interval_s);
      if (range_m >= from_m && range_m < to_m)
        electrons += frames.samples[ray * frames.samples_per_ray + i] *
                     frames.calibration.sensor.gain_e_per_dn;
    }
    sum += electrons / rays;
    square += electrons * electrons / rays;
  }
  return {sum, std::sqrt(std::max(square - sum * sum, 0.0) / rays)};
}

// Two independent routes to one waveform: fog of even density is a closed form, the same fog on a
// grid is traced by paths (delta tracking, scattered once). Four standard errors over 200 pulses.
TEST(LidarInFog, IsTheSameByPathsAndInClosedForm) {
  PulsedLidar s = lidar();
  s.pattern = RasterPattern{.rows = 10, .columns = 20, .height_rad = 1e-3, .width_rad = 1e-3};
  s.electrons_at_10m = 2e5;
  s.overlap_m = 2;
  s.min_range_m = 5;
  s.max_range_m = 25;
  Scene even{.objects = {plane_at(18)}, .materials = {plain(0.2)}};
  even.medium = fog(60, 0, 0.8);
  Scene grid = even;
  grid.medium->density =
      DensityGrid{.box_m = {Eigen::Vector3d(-100, -100, -100), Eigen::Vector3d(100, 100, 100)},
                  .cells = {4, 4, 4},
                  .density = std::vector<float>(64, 1)};
  const auto frames_of = [&](const Scene& scene) {
    return std::get<Waveforms>(
        render(s, RayCaster(scene), Pose::Identity(), {}, {Effect::medium}).frames);
  };
  const Waveforms by_formula = frames_of(even), by_paths = frames_of(grid);
  for (const auto& [from_m, to_m] : {std::pair(7.0, 9.0), {9.0, 13.0}, {16.5, 19.5}}) {
    const Stretch closed = stretch(by_formula, from_m, to_m);
    const Stretch traced = stretch(by_paths, from_m, to_m);
    EXPECT_NEAR(traced.mean, closed.mean, 4 * traced.error) << from_m;
    EXPECT_LT(traced.error, 0.01 * closed.mean);
  }
}

// Fog before a wall: its light ends at the wall, and the decoder finds the wall to what the fog's
// last slope may pull (weigh_pulsed_lidar.cpp): B W^2 / 2 over N samples.
TEST(LidarInFog, FindsTheWall) {
  PulsedLidar s = lidar();
  s.ambient_electrons = 50;
  s.overlap_m = 5;
  s.sensor = {.gain_e_per_dn = 0.25, .offset_dn = 10, .bits = 16};
  Scene scene{.objects = {plane_at(30)}, .materials = {plain(0.5)}};
  scene.medium = fog(300, 0.5, 0.9);
  const Scan scan =
      acquire(render(s, RayCaster(scene), Pose::Identity(), {}, {Effect::medium}).frames);
  ASSERT_EQ(scan.cloud.size(), 1u);
  EXPECT_NEAR(scan.cloud.points[0].norm(), 30, 2e-3);
}

// The window opens amid near fog, brighter than the wall's echo needs to be: the wall is found all
// the same. At 15 m 390 electrons of its own and 12 of noise a sample leave sigma at 30 mm; 5 sigma
// by the points' own word.
TEST(LidarInFog, FindsTheWallBehindNearFog) {
  PulsedLidar s;
  s.pattern = RasterPattern{.rows = 20, .columns = 25, .height_rad = 0.4, .width_rad = 0.5};
  s.electrons_at_10m = 2e4;
  s.sensor = {.gain_e_per_dn = 4, .offset_dn = 20, .read_noise_e = 10, .bits = 14};
  s.min_range_m = 2;
  s.max_range_m = 40;
  Scene scene{.objects = {plane_at(15, 0.17)}, .materials = {plain(0.5)}};
  scene.medium = fog(200, 0.8, 0.95);
  const RayCaster caster(scene);
  const Scan scan = acquire(render(s, caster, Pose::Identity(), {.seed = 5, .scan = 0},
                                   EffectSet(sensor_effects).set(Effect::medium))
                                .frames);
  const auto truth = true_rays(s, caster, Pose::Identity());
  EXPECT_GE(scan.cloud.size(), 495u);
  int astray = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    astray += std::abs(scan.cloud.points[i].norm() - truth[scan.ray[i]].point_in_scanner.norm()) >
              5 * scan.cloud.sigma_m[i];
  EXPECT_LE(astray, 5);
}

}  // namespace
}  // namespace scan::synth
