// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Periods of a phase camera: of its wiggling, of its folds.
#include <complex>

#include "libscan/acquire/phase.h"
#include "libscan/core/units.h"
#include "tests/validation/scanner_range.h"

namespace scan::synth {
namespace {

using std::numbers::pi;

// Range that a single pixel reads of a wall at z.
std::optional<double> read_range_m(PhaseCamera s, double z_m, const EffectSet& effects) {
  s.camera = {.width_px = 1, .height_px = 1, .fx_px = 1e6, .fy_px = 1e6};
  s.electrons_at_1m = 40000 * z_m * z_m;
  const Eigen::AngleAxisd facing(pi, Eigen::Vector3d::UnitY());
  const Scene scene{
      .objects = {{.name = "wall",
                   .world_from_object = make_pose(facing.toRotationMatrix(), {0, 0, z_m}),
                   .geometry = Shape(PlaneShape{}),
                   .material = 0}},
      .materials = {{.name = "white", .bsdf = Lambert{1}, .texture = {}}}};
  const Scan scan = acquire(render(s, RayCaster(scene), Pose::Identity(), {}, effects).frames);
  if (scan.cloud.empty()) return std::nullopt;
  return scan.cloud.points[0].norm();
}

// Error over one unambiguous range R = c / 2f, as amplitudes of its waves: bin k has k periods in
// R.
std::array<std::complex<double>, 13> error_spectrum_m(double third, double fifth) {
  PhaseCamera s;
  s.frequencies_hz = {80e6};
  s.harmonics = {0.02, third, 0.02, fifth};
  const double range_m = speed_of_light_m_s / (2 * 80e6);
  std::array<std::complex<double>, 13> spectrum{};
  constexpr int steps = 64;
  for (int i = 0; i < steps; ++i) {
    const double z_m = (i + 0.5) / steps * range_m;
    const double error = *read_range_m(s, z_m, {Effect::wiggling}) - z_m;
    const double folded = error - range_m * std::round(error / range_m);
    for (std::size_t k = 0; k < spectrum.size(); ++k)
      spectrum[k] +=
          std::polar(2.0 / steps * folded, -2 * pi * static_cast<double>(k) * z_m / range_m);
  }
  return spectrum;
}

// A third harmonic of share h: amplitude h c / (4 pi f), period R / 4, and h^2 / 2 of it at R / 8
// (the argument of 1 + h exp(-4 i phi) is h sin - h^2 / 2 sin(8 phi)); the fifth likewise with the
// other sign. Even harmonics do nothing. Rounding: half an electron of A = 20,000 is sqrt(2) / 4e4
// rad, 0.01 mm.
TEST(Wiggling, HasAQuarterOfTheUnambiguousRangeAsPeriod) {
  const double unit_m = speed_of_light_m_s / (4 * pi * 80e6);
  for (const auto& [third, fifth] : {std::pair(0.06, 0.0), {0.0, 0.06}, {-0.04, 0.01}}) {
    const auto spectrum = error_spectrum_m(third, fifth);
    const double amplitude_m = (fifth - third) * unit_m;
    std::printf("wiggling: third %.2f, fifth %.2f: %.3f mm with period R / 4, expected %.3f mm\n",
                third, fifth, -spectrum[4].imag() * 1e3, amplitude_m * 1e3);
    EXPECT_NEAR(-spectrum[4].imag(), amplitude_m, 1e-5 + unit_m * std::pow(0.06, 3));
    EXPECT_NEAR(spectrum[4].real(), 0, 1e-5);
    for (std::size_t k = 0; k < spectrum.size(); ++k)
      if (k % 4 != 0) {
        EXPECT_LT(std::abs(spectrum[k]), 1e-5) << k;
      }
    const double second_order = std::pow(std::abs(third) + std::abs(fifth), 2) / 2;
    EXPECT_LE(std::abs(spectrum[8]), second_order * unit_m * 1.01 + 1e-5);
  }
}

// 16, 80 and 120 MHz repeat after c / (2 * 8 MHz) = 18.74 m; to there every range is read as it is,
// from there on less that. Rounding as above, at 16 MHz and up: 0.03 mm.
TEST(Unwrapping, ReachesTheRangeOfTheCommonDivisor) {
  PhaseCamera s;
  s.frequencies_hz = {16e6, 80e6, 120e6};
  s.max_range_m = 1000;
  const double period_m = speed_of_light_m_s / (2 * 8e6);
  EXPECT_NEAR(period_m, 18.74, 0.005);
  for (int i = 1; i < 40; ++i) {
    const double z_m = i * period_m / 40;
    EXPECT_NEAR(read_range_m(s, z_m, {}).value_or(-1), z_m, 3e-5) << z_m;
    EXPECT_NEAR(read_range_m(s, z_m + period_m, {}).value_or(-1), z_m, 3e-5) << z_m;
  }
  // each frequency alone: c / 2f
  for (const auto& [frequency_hz, range_m] :
       {std::pair(16e6, 9.369), {80e6, 1.874}, {120e6, 1.249}}) {
    PhaseCamera one;
    one.frequencies_hz = {frequency_hz};
    EXPECT_NEAR(speed_of_light_m_s / (2 * frequency_hz), range_m, 0.0005);
    EXPECT_NEAR(read_range_m(one, 1.1 * range_m, {}).value_or(-1),
                1.1 * range_m - speed_of_light_m_s / (2 * frequency_hz), 6e-5);
  }
}

}  // namespace
}  // namespace scan::synth
