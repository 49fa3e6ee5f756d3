// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/units.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

PulsedLidar lidar() {
  PulsedLidar lidar;
  lidar.pattern = RasterPattern{.rows = 60, .columns = 80, .height_rad = 0.5, .width_rad = 0.7};
  lidar.sensor = {.gain_e_per_dn = 4, .offset_dn = 8, .bits = 10};
  lidar.ambient_electrons = 5;
  lidar.max_range_m = 30;
  return lidar;
}

// What the decoder's fit makes of a pulse, to first order in its deviation r from the model m, a
// Gaussian of the recorded width: the centre moves by sum(w m' r) / sum(w m'^2) with the weights
// w = 1 / (V + m), V the background's variance, over 3 sigma about the top sample. Everything in
// samples. Three deviations:
// 1. the pulse is a Gaussian integrated over intervals, not a Gaussian of equal width;
// 2. rounding, at most half a step in each sample, in the worst combination of signs;
// 3. the level of the background, lifted by level_e.
double fit_error_samples(double pulse, double centre, double echo_e, double variance_e2,
                         double level_e, double step_e) {
  const double width = std::sqrt(pulse * pulse + 1.0 / 12);
  const double height_e = echo_e / (std::sqrt(2 * std::numbers::pi) * width);
  const int reach = static_cast<int>(std::ceil(3 * width));
  double information = 0, shape = 0, rounding = 0, level = 0;
  for (int i = -reach; i <= reach; ++i) {
    const double u = (i - centre) / width;
    const double model_e = height_e * std::exp(-u * u / 2);
    const double slope_e = model_e * u / width, weight = 1 / (variance_e2 + model_e);
    const auto edge = [&](double x) {
      return std::erf((x - centre) / (std::numbers::sqrt2 * pulse));
    };
    const double recorded_e = echo_e / 2 * (edge(i + 0.5) - edge(i - 0.5));
    information += weight * slope_e * slope_e;
    shape += weight * slope_e * (recorded_e - model_e);
    rounding += weight * std::abs(slope_e) * step_e / 2;
    level += weight * slope_e * level_e;
  }
  return (std::abs(shape) + rounding + std::abs(level)) / information;
}

// The worst place of a pulse between two samples, and the worse of two backgrounds: the true one,
// and the one that the decoder would find if on either side of the pulse two samples of its tail
// stood just below the limit of what it counts as background, 3 sqrt(V + 1) above the median.
double worst_error_samples(const PulsedLidar& s, double echo_e) {
  const double window_s = 2 * (s.max_range_m - s.min_range_m) / speed_of_light_m_s;
  const double tail_share = 4 / (window_s / s.sample_interval_s);
  const double step_e = delivered_sensor(s.sensor, detector_effects(no_effects)).gain_e_per_dn;
  const double variance_e2 = s.ambient_electrons + step_e * step_e / 12;
  const double limit_e = 3 * std::sqrt(variance_e2 + 1);
  const double pulse = s.pulse_sigma_s / s.sample_interval_s;
  double worst = 0;
  for (double centre = -0.5; centre <= 0.5; centre += 0.02)
    for (const double share : {0.0, tail_share})
      worst = std::max(
          worst, fit_error_samples(pulse, centre, echo_e, variance_e2 + share * limit_e * limit_e,
                                   tail_share * limit_e, step_e));
  return worst;
}

double bound_m(const PulsedLidar& s, const RayTruth& ray) {
  const double range_m = ray.point_in_scanner.norm();
  const double cosine = -ray.normal_in_scanner.dot(ray.point_in_scanner) / range_m;
  const double echo_e = s.electrons_at_10m * 0.5 * cosine * 100 / (range_m * range_m);
  return worst_error_samples(s, echo_e) * s.sample_interval_s * speed_of_light_m_s / 2;
}

void check_range(const Target& target, std::size_t least_points) {
  const PulsedLidar s = lidar();
  const RayCaster caster(target.scene);
  const Scan scan = acquire(render(s, caster, Pose::Identity(), {}, no_effects).frames);
  const std::vector<RayTruth> truth = true_rays(s, caster, Pose::Identity());
  const RangeFigures figures = compare(
      scan, truth, [](std::size_t) { return Eigen::Vector3d(0, 0, 0); },
      [&](std::size_t ray) { return bound_m(s, truth[ray]); });
  print("pulsed lidar", target.name, figures);
  EXPECT_GE(figures.points, least_points);
}

TEST(PulsedLidarRange, OfAPlaneIsExactButForSampling) {
  check_range(plane_target(12, {.name = "grey", .bsdf = Lambert{0.5}, .texture = {}}), 60 * 80);
}

// A disc of asin(2 / 12) = 0.167 rad radius in pixels of 1 / 120 and 0.7 / 80 rad; nine tenths of
// it.
TEST(PulsedLidarRange, OfASphereIsExactButForSampling) {
  check_range(sphere_target(12, 2, {.name = "grey", .bsdf = Lambert{0.5}, .texture = {}}), 1080);
}

}  // namespace
}  // namespace scan::synth
