// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/waveform.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "libscan/acquire/pulse_time.h"
#include "libscan/acquire/ray_outcome.h"
#include "libscan/acquire/reason.h"
#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/units.h"

namespace scan {
namespace {

using decoding::missed;
using decoding::RayOutcome;

void check_positive(const char* field, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw Error(Trouble::input, std::string("waveform/") + field + ": " + std::to_string(value) +
                                  ", must be positive");
}

void check(const WaveformCalibration& calibration) {
  decoding::check(calibration.sensor);
  check_positive("sample_interval_s", calibration.sample_interval_s);
  check_positive("pulse_sigma_s", calibration.pulse_sigma_s);
  check_positive("range_walk_electrons", calibration.range_walk_electrons);
  if (!std::isfinite(calibration.window_start_s))
    throw Error(Trouble::input, "waveform/window_start_s: must be finite");
  if (!std::isfinite(calibration.range_walk_s))
    throw Error(Trouble::input, "waveform/range_walk_s: must be finite");
}

void check_count(const char* field, std::size_t count, std::size_t rays) {
  if (count == 0 || count == rays) return;
  throw Error(Trouble::input, std::string("waveform/") + field + ": " + std::to_string(count) +
                                  " for " + std::to_string(rays) + " rays");
}

void check(const Waveforms& frames) {
  check(frames.calibration);
  const std::size_t rays = frames.directions.size();
  if (frames.samples.size() != rays * frames.samples_per_ray ||
      (rays > 0 && frames.samples_per_ray < 3))
    throw Error(Trouble::input, "waveform/samples: " + std::to_string(frames.samples.size()) +
                                    " for " + std::to_string(rays) + " rays of " +
                                    std::to_string(frames.samples_per_ray) +
                                    " samples, at least 3 each");
  check_count("grid", std::size_t{frames.grid.rows} * frames.grid.columns, rays);
  check_count("first_sample", frames.first_sample.size(), rays);
  check_count("scanner_from_ray", frames.scanner_from_ray.size(), rays);
  for (std::size_t ray = 0; ray < rays; ++ray)
    if (!(std::abs(frames.directions[ray].norm() - 1) <= 1e-6))
      throw Error(Trouble::input, "waveform/direction " + std::to_string(ray) + ": length " +
                                      std::to_string(frames.directions[ray].norm()) +
                                      ", must be 1");
}

// How late the echo comes for its strength; of less than an electron as of one.
double walk_s(const WaveformCalibration& calibration, const decoding::PulseTime& pulse) {
  if (calibration.range_walk_s == 0) return 0;
  const double electrons = pulse.height_e * std::sqrt(2 * std::numbers::pi) *
                           calibration.pulse_sigma_s / calibration.sample_interval_s;
  return calibration.range_walk_s *
         std::log10(std::max(electrons, 1.0) / calibration.range_walk_electrons);
}

RayOutcome in_scan_frame(RayOutcome outcome, const Pose& scanner_from_ray) {
  const Eigen::Matrix3d& turn = scanner_from_ray.linear();
  outcome.point = scanner_from_ray * outcome.point;
  outcome.covariance = turn * outcome.covariance * turn.transpose();
  return outcome;
}

RayOutcome decode_ray(const Waveforms& frames, const WaveformOptions& options, std::size_t ray) {
  const WaveformCalibration& calibration = frames.calibration;
  std::vector<double> waveform_e(frames.samples_per_ray);
  for (std::size_t i = 0; i < waveform_e.size(); ++i)
    waveform_e[i] =
        decoding::electrons(calibration.sensor, frames.samples[ray * frames.samples_per_ray + i]);
  const decoding::PulseTime pulse =
      decoding::locate_pulse(waveform_e, calibration.pulse_sigma_s / calibration.sample_interval_s,
                             calibration.sensor, options);
  if (!pulse.miss.empty()) return missed(pulse.miss);
  const double sample = pulse.sample + (frames.first_sample.empty() ? 0 : frames.first_sample[ray]);
  const double half_speed = speed_of_light_m_s / 2;  // there and back
  const double range_m =
      half_speed * (calibration.window_start_s + sample * calibration.sample_interval_s -
                    walk_s(calibration, pulse));
  if (!(range_m > 0)) return missed(reason::out_of_range);
  const RayOutcome outcome =
      decoding::point_on_ray(frames.directions[ray].normalized(), range_m,
                             half_speed * pulse.sigma_samples * calibration.sample_interval_s,
                             pulse.height_e / calibration.sensor.gain_e_per_dn);
  if (frames.scanner_from_ray.empty()) return outcome;
  return in_scan_frame(outcome, frames.scanner_from_ray[ray]);
}

}  // namespace

Scan acquire_waveform(const Waveforms& frames, const WaveformOptions& options) {
  check(frames);
  std::vector<RayOutcome> outcomes(frames.directions.size());
  parallel_for(outcomes.size(),
               [&](std::size_t ray) { outcomes[ray] = decode_ray(frames, options, ray); });
  return decoding::collect(outcomes, frames.grid);
}

}  // namespace scan
