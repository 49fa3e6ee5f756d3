// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar.h"

#include <cmath>
#include <numeric>

#include "libscan/core/units.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {
namespace {

constexpr double c = speed_of_light_m_s;

PulsedLidar small_lidar() {
  PulsedLidar lidar;
  lidar.pattern = RasterPattern{.rows = 6, .columns = 8, .height_rad = 0.3, .width_rad = 0.4};
  lidar.max_range_m = 30;
  return lidar;
}

std::vector<double> waveform(const PulsedLidar& lidar, const Scene& scene,
                             const Eigen::Vector3d& direction = Eigen::Vector3d::UnitZ()) {
  return expected_waveform(lidar, RayCaster(scene), Pose::Identity(), direction);
}

// Energy, mean time and variance of a waveform without its ambient light.
struct Moments {
  double electrons = 0;
  double time_s = 0;
  double variance_s2 = 0;
};

Moments moments_of(const PulsedLidar& lidar, const std::vector<double>& samples) {
  const double start_s = 2 * lidar.min_range_m / c - 4 * lidar.pulse_sigma_s;
  const auto time_s = [&](std::size_t i) { return start_s + i * lidar.sample_interval_s; };
  Moments m;
  for (const double sample : samples) m.electrons += sample - lidar.ambient_electrons;
  for (std::size_t i = 0; i < samples.size(); ++i)
    m.time_s += (samples[i] - lidar.ambient_electrons) / m.electrons * time_s(i);
  for (std::size_t i = 0; i < samples.size(); ++i)
    m.variance_s2 +=
        (samples[i] - lidar.ambient_electrons) / m.electrons * std::pow(time_s(i) - m.time_s, 2);
  return m;
}

Scene scene_of(Object object, double albedo) {
  return {.objects = {std::move(object)}, .materials = {plain(albedo)}};
}

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
  const auto frames =
      std::get<Waveforms>(render(lidar, RayCaster(Scene{}), Pose::Identity(), {}, noise_free));
  EXPECT_NEAR(frames.calibration.pulse_sigma_s, std::sqrt(m.variance_s2), 1e-18);
}

TEST(PulsedLidar, OpensItsWindowFourSigmasBeyondTheRangeLimits) {
  const PulsedLidar lidar = small_lidar();
  const RayCaster nothing(Scene{});
  const auto frames = std::get<Waveforms>(render(lidar, nothing, Pose::Identity(), {}, noise_free));
  const WaveformCalibration& calibration = frames.calibration;
  const double last_s =
      calibration.window_start_s + (frames.samples_per_ray - 1) * calibration.sample_interval_s;
  EXPECT_DOUBLE_EQ(calibration.window_start_s, 2 * lidar.min_range_m / c - 6e-9);
  EXPECT_GE(last_s, 2 * lidar.max_range_m / c + 6e-9);
  EXPECT_LT(last_s, 2 * lidar.max_range_m / c + 6e-9 + lidar.sample_interval_s);
  EXPECT_EQ(frames.samples.size(), 48u * frames.samples_per_ray);
  for (const std::uint16_t dn : frames.samples) EXPECT_EQ(dn, 5);  // ambient light, gain 1
}

// The two moments of the Gaussian with the 1/e^2 radius D(R): none of the first order, D^2 / 4
// along each axis.
TEST(PulsedLidar, SpreadsItsRaysAsTheGaussianBeam) {
  PulsedLidar lidar = small_lidar();
  lidar.exit_radius_m = 0.0035;
  lidar.divergence_rad = 0.35e-3;
  const Eigen::Vector3d axis = Eigen::Vector3d(0.2, -0.3, 1).normalized();
  for (const int rings : {2, 3, 8}) {
    lidar.sub_rays = rings;
    const auto rays = beam_rays(lidar, axis);
    EXPECT_EQ(rays.size(), static_cast<std::size_t>(rings * rings));
    for (const double range_m : {0.0, 10.0, 100.0}) {
      double shares = 0;
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
      for (const BeamRay& ray : rays) {
        EXPECT_NEAR(ray.direction.norm(), 1, 1e-15);
        const double length_m = (range_m - ray.origin.dot(axis)) / ray.direction.dot(axis);
        const Eigen::Vector3d off = ray.origin + length_m * ray.direction - range_m * axis;
        shares += ray.share;
        mean += ray.share * off;
        second += ray.share * off * off.transpose();
      }
      const double radius_m = std::hypot(0.0035, std::tan(0.35e-3 / 2) * range_m);
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
      EXPECT_NEAR(shares, 1, 1e-14);
      EXPECT_LT(mean.norm(), 1e-12 * radius_m + 1e-14);
      EXPECT_LT((second - radius_m * radius_m / 4 * across).norm(), 1e-10 * radius_m * radius_m);
    }
  }
}

// Physics 7.4: diameters 2 D = 7.83, 18.85, 35.69 mm at 10, 50, 100 m for 0.35 mrad and 7 mm exit.
// The outermost of many rings lies beyond 2 D, the share inside 2 D's radius is 1 - e^-2.
TEST(PulsedLidar, HasTheTextbookFootprint) {
  PulsedLidar lidar = small_lidar();
  lidar.exit_radius_m = 0.0035;
  lidar.divergence_rad = 0.35e-3;
  lidar.sub_rays = 40;
  const auto rays = beam_rays(lidar, Eigen::Vector3d::UnitZ());
  for (const auto& [range_m, diameter_m] :
       {std::pair(10.0, 7.83e-3), std::pair(50.0, 18.85e-3), std::pair(100.0, 35.69e-3)}) {
    double inside = 0;
    for (const BeamRay& ray : rays) {
      const Eigen::Vector3d at = ray.origin + range_m / ray.direction.z() * ray.direction;
      if (at.head<2>().norm() < diameter_m / 2) inside += ray.share;
    }
    // A ring has at most (2 * 40 - 1) / 1600 = 5 % of the energy, and one may lie on either side.
    EXPECT_NEAR(inside, 1 - std::exp(-2), 0.05);
  }
}

// Physics 7.4: the 1/e^2 footprint spreads the echo over gamma R tan(theta) = 26 mm at 50 m, 0.3
// mrad, 60 degrees: four standard deviations of a Gaussian. Terms of higher order are gamma
// tan(theta) = 5e-4 of it; reading it from the variance of a 0.1 ns pulse costs 1e-9.
TEST(PulsedLidar, SpreadsTheEchoOfATiltedPlane) {
  PulsedLidar lidar = small_lidar();
  lidar.divergence_rad = 0.3e-3;
  lidar.sub_rays = 6;
  lidar.ambient_electrons = 0;
  lidar.pulse_sigma_s = 1e-10;
  lidar.sample_interval_s = 1e-10;
  lidar.min_range_m = 49;
  lidar.max_range_m = 51;
  const Moments m =
      moments_of(lidar, waveform(lidar, scene_of(plane_at(50, std::numbers::pi / 3), 1)));
  const double own_s2 = lidar.pulse_sigma_s * lidar.pulse_sigma_s * (1 + 1.0 / 12);
  const double spread_m = 4 * c / 2 * std::sqrt(m.variance_s2 - own_s2);
  EXPECT_NEAR(spread_m, 0.3e-3 * 50 * std::tan(std::numbers::pi / 3), 2e-3 * 26e-3);
}

// A plate covers half of the footprint: two echoes, each with the energy of half the beam. A line
// through the axis cuts each ring of 2 k + 1 rays to within half a ray; with the ray on the axis
// that is (rings / 2 + 1) / rings^2 of the energy at most.
TEST(PulsedLidar, SeesTwoSurfacesInsideOneFootprint) {
  PulsedLidar lidar = small_lidar();
  lidar.divergence_rad = 2e-3;
  lidar.sub_rays = 12;
  lidar.ambient_electrons = 0;
  const Scene scene{.objects = {plane_at(20), plate(10, 0, 5)}, .materials = {plain(0.5)}};
  std::vector<double> samples = waveform(lidar, scene);
  const double start_s = 2 * lidar.min_range_m / c - 4 * lidar.pulse_sigma_s;
  const auto between =
      static_cast<std::ptrdiff_t>((2 * 15 / c - start_s) / lidar.sample_interval_s);
  const double first = std::accumulate(samples.begin(), samples.begin() + between, 0.0);
  const double second = std::accumulate(samples.begin() + between, samples.end(), 0.0);
  const double bound = (12 / 2.0 + 1) / 144;
  EXPECT_NEAR(first / (5000 * 0.5), 0.5, bound);
  EXPECT_NEAR(second / (5000 * 0.5 / 4), 0.5, bound);
  EXPECT_NEAR(first / 2500 + second / 625, 1, 1e-5);  // cosines and ranges vary by (1e-3)^2
  EXPECT_EQ(samples[static_cast<std::size_t>(between)], 0);
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
  const auto frames =
      std::get<Waveforms>(render(lidar, RayCaster(Scene{}), Pose::Identity(), {}, {}));
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
    return std::get<Waveforms>(
               render(lidar, RayCaster(scene), Pose::Identity(), {.seed = 3, .scan = 1}, {}))
        .samples;
  });
}

// Against the lens the range equation grows without bound; the reading is that of a full sensor.
TEST(PulsedLidar, SaturatesOnASurfaceAtTheLens) {
  PulsedLidar lidar = small_lidar();
  lidar.min_range_m = 0;
  lidar.max_range_m = 1;
  const auto frames = std::get<Waveforms>(
      render(lidar, RayCaster(scene_of(plane_at(1e-9), 1)), Pose::Identity(), {}, {}));
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
