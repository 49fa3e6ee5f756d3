// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The lidar's footprint.
#include <cmath>
#include <numeric>

#include "synth/scanners/pulsed_lidar_echo.h"
#include "tests/synth/lidar_waveforms.h"

namespace scan::synth {
namespace {

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

// A beam of many sub-rays, by all of them and as render() does it.
struct TwoWays {
  std::vector<double> full, adapted;
  std::size_t echoes = 0;  // of the adapted one
};

TwoWays two_ways(const PulsedLidar& lidar, const Scene& scene) {
  const RayCaster caster(scene);
  const BeamSection section = beam_section(lidar);
  const LidarBeam beam{lidar, caster, section};
  std::vector<Echo> full, adapted;
  beam.sub_ray_echoes(Pose::Identity(), Eigen::Vector3d::UnitZ(), full);
  beam.echoes(Pose::Identity(), Eigen::Vector3d::UnitZ(), adapted);
  const SampleAxis axis = sample_axis(lidar);
  const auto samples = static_cast<std::size_t>(axis.samples);
  TwoWays result{std::vector<double>(samples), std::vector<double>(samples), adapted.size()};
  for (const Echo& echo : full) add_echo(axis, echo, result.full);
  for (const Echo& echo : adapted) add_echo(axis, echo, result.adapted);
  return result;
}

PulsedLidar wide_lidar() {
  PulsedLidar lidar = small_lidar();
  lidar.divergence_rad = 3e-3;
  lidar.exit_radius_m = 0.003;
  lidar.sub_rays = 24;
  return lidar;
}

// Within the pilot's limits the time errs by 0.1 sigma / sqrt(N) and the energy by 0.1 sqrt(N),
// which moves no sample by more than 0.05 sqrt(its electrons) each (the slope of a Gaussian over
// its root is at most sqrt(2 / e)); one electron of ambient light stands for the tails. The shape
// of 24 rings differs from the Gaussian in its fourth moment, by less than the other half.
TEST(AdaptedFootprint, IsTheFullOneWithinATenthOfTheNoise) {
  for (const double tilt_rad : {0.0, 0.6, 1.1, 1.35}) {
    const TwoWays ways = two_ways(wide_lidar(), scene_of(plane_at(20, tilt_rad), 0.5));
    EXPECT_EQ(ways.echoes, 1u) << tilt_rad;
    for (std::size_t i = 0; i < ways.full.size(); ++i)
      EXPECT_NEAR(ways.adapted[i], ways.full[i], 0.1 * std::sqrt(ways.full[i] + 1)) << tilt_rad;
  }
}

// sigma^2 + (2 / c)^2 (D / 2)^2 tan^2(tilt), to the first order in the beam's opening, 1.5e-3
// tan(tilt).
TEST(AdaptedFootprint, StretchesThePulseOnATiltedPlane) {
  PulsedLidar lidar = wide_lidar();
  lidar.electrons_at_10m = 50;  // for wide limits
  const double tilt_rad = 1.3, radius_m = std::hypot(0.003, std::tan(1.5e-3) * 20);
  const RayCaster caster(scene_of(plane_at(20, tilt_rad), 0.5));
  const BeamSection section = beam_section(lidar);
  std::vector<Echo> echoes;
  LidarBeam{lidar, caster, section}.echoes(Pose::Identity(), Eigen::Vector3d::UnitZ(), echoes);
  ASSERT_EQ(echoes.size(), 1u);
  const double spread_s = 2 / c * radius_m / 2 * std::tan(tilt_rad);
  const double expected_s2 = lidar.pulse_sigma_s * lidar.pulse_sigma_s + spread_s * spread_s;
  EXPECT_NEAR(std::pow(echoes[0].sigma_s, 2) / expected_s2, 1, 1.5e-3 * std::tan(tilt_rad));
}

// An edge, a ball smaller than the beam, the plane's end, a bright border: all sub-rays.
TEST(AdaptedFootprint, FallsBackToAllRaysWhereTheSurfaceIsNotEven) {
  const PulsedLidar lidar = wide_lidar();
  const Scene edge{.objects = {plane_at(20), plate(19, 0.003, 5)}, .materials = {plain(0.5)}};
  const Scene end{.objects = {plate(20, -0.01, 5)}, .materials = {plain(0.5)}};
  const Scene paint{.objects = {plate(20, -0.005, 5, 0), plane_at(20.0001, 0, 1)},
                    .materials = {plain(0.9), plain(0.2)}};
  Scene ball = scene_of(sphere_at({0, 0, 20}, 0.05), 0.5);
  for (const Scene& scene : {edge, end, paint, ball}) {
    const TwoWays ways = two_ways(lidar, scene);
    EXPECT_GT(ways.echoes, 100u);
    EXPECT_EQ(ways.full, ways.adapted);
  }
}

}  // namespace
}  // namespace scan::synth
