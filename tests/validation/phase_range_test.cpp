// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/units.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

PhaseCamera camera() {
  PhaseCamera camera;
  camera.camera = {
      .width_px = 120, .height_px = 90, .fx_px = 150, .fy_px = 150, .cx_px = 59.5, .cy_px = 44.5};
  camera.frequencies_hz = {16e6, 80e6, 120e6};
  camera.sensor = {.gain_e_per_dn = 40, .offset_dn = 8, .bits = 10};
  return camera;
}

// A tap is rounded by at most half a step, so C0 - C2 and C3 - C1 by a step at most; the phasor of
// length 2 A turns by at most asin(sqrt(2) step / (2 A)). The distance is a mean over frequencies
// with weights w_i >= 0, so its error is at most the weighted mean of c / (4 pi f_i) times that
// angle; with equal A the decoder's weights are as f_i^2.
double bound_m(const PhaseCamera& s, const RayCaster& caster, std::size_t ray) {
  const auto column = static_cast<int>(ray % s.camera.width_px);
  const auto row = static_cast<int>(ray / s.camera.width_px);
  const double step_e = delivered_sensor(s.sensor, detector_effects(no_effects)).gain_e_per_dn;
  const double amplitude_e =
      std::abs(expected_phasors(s, caster, Pose::Identity(), column, row).amplitude_e[0]);
  const double angle_rad = std::asin(std::min(1.0, step_e / (std::sqrt(2) * amplitude_e)));
  double weights = 0, sum_m = 0;
  for (const double f : s.frequencies_hz) {
    weights += f * f;
    sum_m += f * f * speed_of_light_m_s / (4 * std::numbers::pi * f) * angle_rad;
  }
  // Rounded amplitudes move the weights by 2 sqrt(2) step / (2 A), relative.
  return sum_m / weights * (1 + 2 * angle_rad) + 1e-12;
}

void check_range(const Target& target, std::size_t least_points) {
  const PhaseCamera s = camera();
  const RayCaster caster(target.scene);
  const Scan scan = acquire(render(s, caster, Pose::Identity(), {}, no_effects).frames);
  const RangeFigures figures = compare(
      scan, true_rays(s, caster, Pose::Identity()),
      [](std::size_t) { return Eigen::Vector3d(0, 0, 0); },
      [&](std::size_t ray) { return bound_m(s, caster, ray); });
  print("phase camera", target.name, figures);
  EXPECT_GE(figures.points, least_points);
}

TEST(PhaseCameraRange, OfAPlaneIsExactButForRounding) {
  check_range(plane_target(1.2, {.name = "grey", .bsdf = Lambert{0.5}, .texture = {}}), 120 * 90);
}

// A disc of 150 px * tan(asin(0.3 / 1.2)) = 38.7 px radius less its dim rim: nine tenths of it.
TEST(PhaseCameraRange, OfASphereIsExactButForRounding) {
  check_range(sphere_target(1.2, 0.3, {.name = "grey", .bsdf = Lambert{0.5}, .texture = {}}), 4200);
}

}  // namespace
}  // namespace scan::synth
