// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The lidar's echoes against the textbook: how energy falls with range and fog, how slopes stretch
// a pulse, from which separation on two surfaces are two.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "libscan/core/units.h"
#include "synth/scanners/pulsed_lidar_echo.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

PulsedLidar lidar() {
  PulsedLidar s;
  s.pattern = RasterPattern{.rows = 1, .columns = 1, .height_rad = 0, .width_rad = 0};
  s.ambient_electrons = 0;
  s.max_range_m = 300;
  return s;
}

// Echoes of the beam along +z as render() makes them.
std::vector<Echo> echoes_of(const PulsedLidar& s, const Scene& scene) {
  const RayCaster caster(scene);
  const BeamSection section = beam_section(s);
  std::vector<Echo> echoes;
  LidarBeam{s, caster, section}.echoes(Pose::Identity(), Eigen::Vector3d::UnitZ(), echoes);
  return echoes;
}

double energy_of(const PulsedLidar& s, const Scene& scene) {
  double sum = 0;
  for (const Echo& echo : echoes_of(s, scene)) sum += echo.electrons;
  return sum;
}

Scene with(const Object& object) {
  return {.objects = {object}, .materials = {plain(0.5)}};
}

Object wire(double z_m, double radius_m) {
  return {.name = "wire",
          .world_from_object = make_pose(
              Eigen::AngleAxisd(pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix(), {0, 0, z_m}),
          .geometry = Shape(CylinderShape{radius_m, 100}),
          .material = 0};
}

// Slope of ln(energy) over ln(range) by least squares, from 40 to 200 m.
template <class Place>
double exponent(const PulsedLidar& s, const Place& place) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (double range_m = 40; range_m <= 200; range_m *= 1.15) {
    const double u = std::log(range_m), v = std::log(energy_of(s, with(place(range_m))));
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

// P_r / P_t = rho D^2 / (4 R^2), 2.8125e-7 for rho 0.5, D 0.15 m, R 100 m (physics 7.4), here with
// the beam's full footprint of 64 x 64 sub-rays; cosines and ranges over it vary by gamma^2 = 1e-7.
TEST(LidarRangeEquation, HasTheTextbookValue) {
  PulsedLidar s = lidar();
  const double emitted = 1e10;
  s.electrons_at_10m = emitted * 0.15 * 0.15 / (4 * 10 * 10);
  s.divergence_rad = 0.3e-3;
  s.sub_rays = 64;
  EXPECT_NEAR(energy_of(s, with(plane_at(100))) / emitted, 2.8125e-7, 2.8125e-7 * 1e-6);
}

// Lambert's cosine: at 60 degrees half of it.
TEST(LidarRangeEquation, FallsWithTheCosineOfIncidence) {
  const PulsedLidar s = lidar();
  const double facing = energy_of(s, with(plane_at(100)));
  EXPECT_NEAR(energy_of(s, with(plane_at(100, pi / 3))) / facing, 0.5, 1e-12);
}

// A plane fills the beam: R^-2, exactly but for gamma^2.
TEST(LidarRangeEquation, FallsWithTheSquareOverAPlane) {
  PulsedLidar s = lidar();
  s.divergence_rad = 1e-3;
  s.sub_rays = 8;
  EXPECT_NEAR(exponent(s, [](double z) { return plane_at(z); }), -2, 1e-5);
}

// A wire fills the beam in one direction: one power more. A ball: two. What is seen of them is a
// count of sub-rays: of 64 rings a wire of diameter 2 r takes the share sqrt(2 / pi) 4 r / D, which
// the rings sample to some 3 % of it at 200 m (D = 0.4 m, 64^2 rays); over a range of a factor 5
// the slope errs by 0.03 sqrt(12 / n) / ln(5) = 0.02.
TEST(LidarRangeEquation, FallsWithTheCubeOverAWire) {
  PulsedLidar s = lidar();
  s.divergence_rad = 4e-3;
  s.sub_rays = 64;
  EXPECT_NEAR(exponent(s, [](double z) { return wire(z, 0.01); }), -3, 0.06);
}

TEST(LidarRangeEquation, FallsWithTheFourthPowerOverABall) {
  PulsedLidar s = lidar();
  s.divergence_rad = 8e-3;
  s.sub_rays = 64;
  EXPECT_NEAR(exponent(s, [](double z) { return sphere_at({0, 0, z}, 0.04); }), -4, 0.06);
}

// Physics 7.4: Delta R = gamma R tan(theta), four standard deviations: 26 mm and 170 mm. The
// beam's second order is gamma tan(theta), 1.7e-3 at 80 degrees; the golden values have two digits.
TEST(LidarFootprint, SpreadsOverATiltedPlane) {
  PulsedLidar s = lidar();
  s.divergence_rad = 0.3e-3;
  s.sub_rays = 6;
  s.electrons_at_10m = 1e5;
  const struct {
    double range_m, tilt_rad, spread_m;
  } golden[] = {{50, pi / 3, 0.026}, {100, 80 * pi / 180, 0.170}};
  for (const auto& [range_m, tilt_rad, spread_m] : golden) {
    const auto echoes = echoes_of(s, with(plane_at(range_m, tilt_rad)));
    ASSERT_EQ(echoes.size(), 1u);
    const double stretch_s2 =
        echoes[0].sigma_s * echoes[0].sigma_s - s.pulse_sigma_s * s.pulse_sigma_s;
    const double found_m = 4 * speed_of_light_m_s / 2 * std::sqrt(stretch_s2);
    EXPECT_NEAR(found_m / (0.3e-3 * range_m * std::tan(tilt_rad)), 1, 2e-3);
    EXPECT_NEAR(found_m, spread_m, 0.5e-3);
  }
}

// Two equal echoes show a valley once they stand apart by the pulse's width tau between its points
// of inflection, 2 sigma: the surfaces by c tau / 2. By bisection on waveforms of 0.01 ns, whose
// box widens the pulse by 1e-5 of its variance.
TEST(LidarResolution, IsHalfThePulse) {
  for (const double sigma_s : {0.25e-9, 1e-9, 2e-9}) {
    PulsedLidar s = lidar();
    s.pulse_sigma_s = sigma_s;
    s.sample_interval_s = sigma_s / 100;
    s.min_range_m = 9;
    s.max_range_m = 12;
    s.divergence_rad = 1e-4;
    s.sub_rays = 16;
    const SampleAxis axis = sample_axis(s);
    const auto has_valley = [&](double extra_m) {
      // the far surface is brighter by its range squared: equal echoes
      const double nearer = 1 / std::pow(1 + extra_m / 10, 2);
      std::vector<double> samples(static_cast<std::size_t>(axis.samples));
      Scene scene{.objects = {plane_at(10), plane_at(10 + extra_m)},
                  .materials = {plain(0.5 * nearer), plain(0.5)}};
      scene.objects[1].material = 1;
      for (const Object& object : scene.objects) {
        Scene alone{.objects = {object}, .materials = scene.materials};
        for (const Echo& echo : echoes_of(s, alone)) add_echo(axis, echo, samples);
      }
      const auto middle = static_cast<std::size_t>(
          std::lround(((20 + extra_m) / speed_of_light_m_s - axis.start_s) / axis.interval_s));
      return samples[middle] < 0.99999 * *std::max_element(samples.begin(), samples.end());
    };
    double low_m = 0, high_m = 4 * speed_of_light_m_s * sigma_s;
    for (int i = 0; i < 20; ++i) {
      const double extra_m = (low_m + high_m) / 2;
      (has_valley(extra_m) ? high_m : low_m) = extra_m;
    }
    EXPECT_NEAR(high_m / (speed_of_light_m_s * 2 * sigma_s / 2), 1, 0.01) << sigma_s;
  }
}

}  // namespace
}  // namespace scan::synth
