// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar.h"

#include <cmath>

#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

// N = N10 albedo cos (10 / R)^2; the sum over samples of the integrals is the whole pulse but for
// what lies beyond 9 sigma, and for rounding of 300 ambient samples.
TEST(PulsedLidar, ReceivesByTheRangeEquation) {
  for (const double z_m : {5.0, 10.0, 25.0})
    for (const double tilt_rad : {0.0, 1.0}) {
      const Scene scene = scene_of(plane_at(z_m, tilt_rad), 0.3);
      const double expected = 5000 * 0.3 * std::cos(tilt_rad) * 100 / (z_m * z_m);
      EXPECT_NEAR(moments_of(small_lidar(), waveform(small_lidar(), scene)).electrons / expected, 1,
                  1e-11);
    }
}

// Physics 7.4: P_r / P_t = rho D^2 / (4 R^2) = 2.8125e-7 for rho 0.5, aperture D 0.15 m, R 100 m.
TEST(PulsedLidar, GivesTheTextbookRatioAtAHundredMetres) {
  PulsedLidar lidar = small_lidar();
  const double emitted = 1e10;
  lidar.electrons_at_10m = emitted * 0.15 * 0.15 / (4 * 10 * 10);
  lidar.ambient_electrons = 0;
  lidar.min_range_m = 90;
  lidar.max_range_m = 110;
  const Moments m = moments_of(lidar, waveform(lidar, scene_of(plane_at(100), 0.5)));
  EXPECT_NEAR(m.electrons / emitted, 2.8125e-7, 1e-16);
}

// Sums over samples h apart differ from integrals by the spectrum at multiples of 1/h (Poisson's
// summation). The box of one interval has a zero of first order there, so the energy is exact and
// the mean time errs by at most h / pi exp(-2 pi^2 sigma^2 / h^2) (multiples beyond the first are
// smaller by exp(-6 pi^2 sigma^2 / h^2)). Sampling points instead of integrals would miss energy.
TEST(PulsedLidar, KeepsEnergyAndTimeOfCoarselySampledPulses) {
  for (const double sigma_s : {0.3e-9, 0.5e-9, 1.5e-9})
    for (const double z_m : {7.01, 7.05, 7.123}) {
      PulsedLidar lidar = small_lidar();
      lidar.pulse_sigma_s = sigma_s;
      lidar.ambient_electrons = 0;
      const Moments m = moments_of(lidar, waveform(lidar, scene_of(plane_at(z_m), 1)));
      const double h = lidar.sample_interval_s, ratio = std::numbers::pi * sigma_s / h;
      const double bound_s = h / std::numbers::pi * std::exp(-2 * ratio * ratio);
      EXPECT_NEAR(m.electrons / (5000 * 100 / (z_m * z_m)), 1, 1e-12);
      EXPECT_NEAR(m.time_s, 2 * z_m / c, 1.001 * bound_s + 1e-21);
    }
}

// Variances of pulse and box add: sigma^2 + h^2 / 12.
TEST(PulsedLidar, WidensThePulseByItsInterval) {
  PulsedLidar lidar = small_lidar();
  lidar.ambient_electrons = 0;
  const Moments m = moments_of(lidar, waveform(lidar, scene_of(plane_at(8), 1)));
  EXPECT_NEAR(m.variance_s2, 1.5e-9 * 1.5e-9 + 1e-18 / 12, 1e-27);
  const auto frames = std::get<Waveforms>(
      render(lidar, RayCaster(Scene{}), Pose::Identity(), {}, noise_free).frames);
  EXPECT_NEAR(frames.calibration.pulse_sigma_s, std::sqrt(m.variance_s2), 1e-18);
}

TEST(PulsedLidar, OpensItsWindowFourSigmasBeyondTheRangeLimits) {
  const PulsedLidar lidar = small_lidar();
  const RayCaster nothing(Scene{});
  const auto frames =
      std::get<Waveforms>(render(lidar, nothing, Pose::Identity(), {}, noise_free).frames);
  const WaveformCalibration& calibration = frames.calibration;
  const double last_s =
      calibration.window_start_s + (frames.samples_per_ray - 1) * calibration.sample_interval_s;
  EXPECT_DOUBLE_EQ(calibration.window_start_s, 2 * lidar.min_range_m / c - 6e-9);
  EXPECT_GE(last_s, 2 * lidar.max_range_m / c + 6e-9);
  EXPECT_LT(last_s, 2 * lidar.max_range_m / c + 6e-9 + lidar.sample_interval_s);
  EXPECT_EQ(frames.samples.size(), 48u * frames.samples_per_ray);
  for (const std::uint16_t dn : frames.samples) EXPECT_EQ(dn, 5);  // ambient light, gain 1
}

TEST(PulsedLidar, AimsARasterAboutItsAxis) {
  PulsedLidar lidar = small_lidar();
  const auto rays = ray_directions(lidar);
  ASSERT_EQ(rays.size(), 48u);
  for (const auto& ray : rays) EXPECT_NEAR(ray.norm(), 1, 1e-15);
  // Opposite corners mirror each other; the first is up (y < 0) and left (x < 0).
  EXPECT_LT((rays.front().cwiseProduct(Eigen::Vector3d(-1, -1, 1)) - rays.back()).norm(), 1e-15);
  EXPECT_LT(rays.front().x(), 0);
  EXPECT_LT(rays.front().y(), 0);
  EXPECT_NEAR(std::atan2(rays[1].x(), rays[1].z()) - std::atan2(rays[0].x(), rays[0].z()), 0.4 / 8,
              1e-15);
  EXPECT_NEAR(std::asin(rays[8].y()) - std::asin(rays[0].y()), 0.3 / 6, 1e-15);
}

TEST(PulsedLidar, TurnsItsFanThroughTheFullCircle) {
  PulsedLidar lidar = small_lidar();
  lidar.pattern = SpinningPattern{.rows = 5, .columns = 16, .lowest_rad = -0.3, .highest_rad = 0.1};
  const auto rays = ray_directions(lidar);
  ASSERT_EQ(rays.size(), 80u);
  EXPECT_NEAR(std::asin(-rays.front().y()), 0.1, 1e-15);  // the highest first, y points down
  EXPECT_NEAR(std::asin(-rays.back().y()), -0.3, 1e-15);
  EXPECT_NEAR(rays[4].z(), 0, 1e-15);  // a quarter turn from +z towards +x
  EXPECT_GT(rays[4].x(), 0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int column = 0; column < 16; ++column) sum += rays[column];
  EXPECT_NEAR(std::hypot(sum.x(), sum.z()), 0, 1e-14);
}

TEST(PulsedLidar, KnowsWhereItsRaysEnd) {
  const PulsedLidar lidar = small_lidar();
  const Eigen::Vector3d centre(0.1, -0.2, 8);
  const Scene scene = scene_of(sphere_at(centre, 3), 0.5);  // wider than the field of view
  const auto rays = true_rays(lidar, RayCaster(scene), Pose::Identity());
  const auto directions = ray_directions(lidar);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double distance_m = distance_to_sphere(directions[i], centre, 3);
    EXPECT_LT((rays[i].point_in_scanner - distance_m * directions[i]).norm(), 1e-12);
    const Moments m = moments_of(lidar, waveform(lidar, scene, directions[i]));
    EXPECT_NEAR(m.time_s * c / 2, distance_m,
                1e-9);  // ambient light rounds at 1e-13 of 400 samples
  }
}

TEST(PulsedLidar, SeesItsSceneFromAnyPose) {
  const PulsedLidar lidar = small_lidar();
  Scene scene = scene_of(plane_at(12, 0.4), 0.5);
  const auto here = waveform(lidar, scene);
  const Pose away = exp((Vector6() << 0.3, -0.5, 2, 4, -7, 1).finished());
  scene.objects[0].world_from_object = away * scene.objects[0].world_from_object;
  const auto there = expected_waveform(lidar, RayCaster(scene), away, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(here.size(), there.size());
  // 1e-14 m of range move a slope of 600 e / 1.5 ns by 1e-10 e at most.
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(here[i], there[i], 1e-8);
}

// Each sample is a Poisson number of mean 5 plus read noise of 2 e: mean 5, variance 5 + 4 (+ 1/12
// of rounding). Clipping at 0 is avoided by an offset. Five standard errors for n = 2e4.
TEST(PulsedLidar, ReadsNoiseInEverySample) {
  PulsedLidar lidar = small_lidar();
  lidar.sensor.read_noise_e = 2;
  lidar.sensor.offset_dn = 100;
  const auto frames = std::get<Waveforms>(
      render(lidar, RayCaster(Scene{}), Pose::Identity(), {}, sensor_effects).frames);
  const auto n = static_cast<double>(frames.samples.size());
  double sum = 0, sum2 = 0;
  for (const std::uint16_t dn : frames.samples) {
    sum += dn - 105.0;
    sum2 += (dn - 105.0) * (dn - 105.0);
  }
  const double variance = 5 + 4 + 1.0 / 12;
  EXPECT_NEAR(sum / n, 0, 5 * std::sqrt(variance / n));
  // The excess kurtosis of the sum is below 0.1: var(s^2) is about 2 variance^2 / n.
  EXPECT_NEAR(sum2 / n / variance, 1, 5 * std::sqrt(2.1 / n));
}

TEST(PulsedLidar, RendersTheSameBytesForAnyThreadCount) {
  PulsedLidar lidar = small_lidar();
  lidar.sub_rays = 3;
  lidar.divergence_rad = 5e-3;
  lidar.sensor.read_noise_e = 3;
  const Scene scene = scene_of(sphere_at({0, 0, 8}, 1), 0.6);
  expect_same_for_any_thread_count([&] {
    return std::get<Waveforms>(render(lidar, RayCaster(scene), Pose::Identity(),
                                      {.seed = 3, .scan = 1}, sensor_effects)
                                   .frames)
        .samples;
  });
}

// Against the lens the range equation grows without bound; the reading is that of a full sensor.
TEST(PulsedLidar, SaturatesOnASurfaceAtTheLens) {
  PulsedLidar lidar = small_lidar();
  lidar.min_range_m = 0;
  lidar.max_range_m = 1;
  const auto frames = std::get<Waveforms>(
      render(lidar, RayCaster(scene_of(plane_at(1e-9), 1)), Pose::Identity(), {}, sensor_effects)
          .frames);
  EXPECT_EQ(*std::max_element(frames.samples.begin(), frames.samples.end()), 65535);
}

TEST(PulsedLidar, NamesTheFieldThatIsWrong) {
  EXPECT_EQ(complaint(small_lidar()), "");
  const auto with = [](auto change) {
    PulsedLidar lidar = small_lidar();
    change(lidar);
    return complaint(lidar);
  };
  EXPECT_EQ(with([](auto& l) { l.pulse_sigma_s = 0; }),
            "pulsed_lidar/pulse_sigma_s: 0, must be positive and finite");
  EXPECT_EQ(with([](auto& l) { l.sample_interval_s = -1e-9; }),
            "pulsed_lidar/sample_interval_s: -1e-09, must be positive and finite");
  EXPECT_EQ(with([](auto& l) { l.max_range_m = 0.1; }),
            "pulsed_lidar/max_range_m: 0.1, must be from 0.5 to 1e+09");
  EXPECT_EQ(with([](auto& l) { l.pattern = RasterPattern{.rows = 0}; }),
            "pulsed_lidar/pattern.rows: 0, must be from 1 to 1000000");
  EXPECT_EQ(
      with([](auto& l) { l.pattern = SpinningPattern{.lowest_rad = 0.2, .highest_rad = 0.1}; }),
      "pulsed_lidar/pattern.highest_rad: 0.1, must be from 0.2 to 1.57079633");
  EXPECT_EQ(with([](auto& l) { l.sub_rays = 0; }),
            "pulsed_lidar/sub_rays: 0, must be from 1 to 64");
  EXPECT_NE(with([](auto& l) { l.divergence_rad = 2; }).find("divergence_rad: 2"),
            std::string::npos);
  EXPECT_NE(with([](auto& l) { l.exit_radius_m = std::nan(""); }).find("exit_radius_m: nan"),
            std::string::npos);
  EXPECT_NE(with([](auto& l) { l.max_range_m = 1e7; }).find("samples"), std::string::npos);
}

}  // namespace
}  // namespace scan::synth
