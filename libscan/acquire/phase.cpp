// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "libscan/acquire/phase_unwrap.h"
#include "libscan/acquire/ray_outcome.h"
#include "libscan/acquire/reason.h"
#include "libscan/acquire/sensor_model.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/units.h"

namespace scan {
namespace {

using decoding::missed;
using decoding::RayOutcome;

constexpr double most_wraps = 10'000;

void check_frequencies(const PhaseCalibration& calibration, std::size_t sets) {
  const std::vector<double>& frequencies = calibration.frequencies_hz;
  if (frequencies.empty() || frequencies.size() != sets)
    throw Error(Trouble::input, "phase camera: " + std::to_string(sets) + " sets of taps for " +
                                    std::to_string(frequencies.size()) + " frequencies");
  for (const double frequency : frequencies)
    if (!(frequency >= 1 && frequency <= 1e12))
      throw Error(Trouble::input, "phase camera/frequencies_hz: " + std::to_string(frequency) +
                                      ", must be 1 to 1e12");
  if (!(calibration.max_range_m > 0))
    throw Error(Trouble::input, "phase camera/max_range_m: " +
                                    std::to_string(calibration.max_range_m) + ", must be positive");
}

void check(const PhaseTaps& frames) {
  const Camera& camera = frames.calibration.camera;
  scan::check(camera);
  decoding::check(frames.calibration.sensor);
  check_frequencies(frames.calibration, frames.taps.size());
  for (const auto& set : frames.taps)
    for (const Image<std::uint16_t>& tap : set)
      if (tap.width != camera.width_px || tap.height != camera.height_px)
        throw Error(Trouble::input, "phase camera/tap: " + std::to_string(tap.width) + " x " +
                                        std::to_string(tap.height) +
                                        " px, the camera's calibration has another size");
}

// How far the search for wraps goes: no further than where all the frequencies' phases repeat.
double search_range_m(const PhaseCalibration& calibration) {
  const double range_m =
      std::min(calibration.max_range_m, decoding::combined_period_m(calibration.frequencies_hz));
  const double highest =
      *std::max_element(calibration.frequencies_hz.begin(), calibration.frequencies_hz.end());
  const double wraps = range_m * 2 * highest / speed_of_light_m_s;
  if (wraps > most_wraps)
    throw Error(Trouble::input,
                "phase camera/max_range_m: " + std::to_string(range_m) + " m are " +
                    std::to_string(wraps) + " wraps, the limit is " + std::to_string(most_wraps),
                "set max_range_m to what the scene needs");
  return range_m;
}

struct Demodulated {
  std::string_view miss = {};
  decoding::FoldedDistance folded = {};
  double amplitude_e = 0;
};

// One frequency of one pixel. C_k = B + A cos(phi + k pi/2) gives C0 - C2 = 2 A cos phi and
// C3 - C1 = 2 A sin phi. With the variance V = B + read noise^2 + rounding of each tap (Poisson)
// sigma_phi = sqrt(V / 2) / A, so sigma_d = c / (4 pi f) sigma_phi = c / (4 sqrt(2) pi f) sqrt(V) /
// A (Lange and Seitz 2001), and sigma_A = sqrt(V / 2).
Demodulated demodulate(const std::array<double, 4>& dn, const Sensor& sensor, double frequency_hz,
                       double min_amplitude_sigmas) {
  if (*std::max_element(dn.begin(), dn.end()) >= decoding::saturation_dn(sensor))
    return {.miss = reason::saturated};
  const double in_phase = (dn[0] - dn[2]) * sensor.gain_e_per_dn / 2;
  const double quadrature = (dn[3] - dn[1]) * sensor.gain_e_per_dn / 2;
  const double amplitude_e = std::hypot(in_phase, quadrature);
  const double offset_e = decoding::electrons(sensor, (dn[0] + dn[1] + dn[2] + dn[3]) / 4);
  const double sigma_e = std::sqrt(decoding::variance_e2(sensor, offset_e) / 2);
  if (!(amplitude_e > 0 && amplitude_e >= min_amplitude_sigmas * sigma_e))
    return {.miss = reason::no_signal};
  const double turns = std::atan2(quadrature, in_phase) / (2 * std::numbers::pi);
  const double period_m = speed_of_light_m_s / (2 * frequency_hz);
  const double sigma_rad = sigma_e / amplitude_e;
  return {.folded = {(turns - std::floor(turns)) * period_m,
                     sigma_rad / (2 * std::numbers::pi) * period_m, period_m},
          .amplitude_e = amplitude_e};
}

RayOutcome decode_pixel(const PhaseTaps& frames, const PhaseOptions& options, double range_m,
                        std::size_t pixel) {
  const PhaseCalibration& calibration = frames.calibration;
  std::vector<decoding::FoldedDistance> folded;
  double amplitude_e = 0;
  for (std::size_t f = 0; f < frames.taps.size(); ++f) {
    std::array<double, 4> dn;
    for (std::size_t k = 0; k < 4; ++k) dn[k] = frames.taps[f][k].pixels[pixel];
    const Demodulated one = demodulate(dn, calibration.sensor, calibration.frequencies_hz[f],
                                       options.min_amplitude_sigmas);
    if (!one.miss.empty()) return missed(one.miss);
    folded.push_back(one.folded);
    amplitude_e += one.amplitude_e / static_cast<double>(frames.taps.size());
  }
  const auto distance = decoding::unwrap(folded, range_m, options.max_inconsistency_sigmas);
  if (!distance.miss.empty()) return missed(distance.miss);
  const auto width = static_cast<std::size_t>(calibration.camera.width_px);
  const std::size_t row = pixel / width, column = pixel % width;
  const auto ray =
      ray_through(calibration.camera, {static_cast<double>(column), static_cast<double>(row)});
  if (!ray) return missed(reason::undetermined);
  return decoding::point_on_ray(ray->normalized(), distance.distance_m, distance.sigma_m,
                                amplitude_e / calibration.sensor.gain_e_per_dn);
}

}  // namespace

Scan acquire_phase(const PhaseTaps& frames, const PhaseOptions& options) {
  check(frames);
  const double range_m = search_range_m(frames.calibration);
  const Camera& camera = frames.calibration.camera;
  std::vector<RayOutcome> outcomes(static_cast<std::size_t>(camera.width_px) * camera.height_px);
  parallel_for(outcomes.size(), [&](std::size_t pixel) {
    outcomes[pixel] = decode_pixel(frames, options, range_m, pixel);
  });
  return decoding::collect(outcomes, {static_cast<std::uint32_t>(camera.height_px),
                                      static_cast<std::uint32_t>(camera.width_px)});
}

}  // namespace scan
