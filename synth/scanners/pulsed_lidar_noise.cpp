// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libscan/core/units.h"

namespace scan::synth {

using std::numbers::pi;

EchoNoise echo_noise(const PulsedLidar& s, double electrons) {
  const double width = std::hypot(s.pulse_sigma_s / s.sample_interval_s, std::sqrt(1.0 / 12));
  const double total_e = std::max(electrons, 1.0);
  return {.width = width,
          .height_e = total_e / (width * std::sqrt(2 * pi)),
          .m_per_sample = speed_of_light_m_s / 2 * s.sample_interval_s,
          .total_e = total_e};
}

double EchoNoise::shot_m() const {
  return m_per_sample * width / std::sqrt(total_e);
}

// variance / sum m'^2 with sum m'^2 = sqrt(pi) A^2 / (2 w) for the height A.
double EchoNoise::white_m(double variance_e2) const {
  return m_per_sample * std::sqrt(2 * width / std::sqrt(pi) * variance_e2) / height_e;
}

double EchoNoise::all_m(double variance_e2) const {
  return std::hypot(shot_m(), white_m(variance_e2));
}

double EchoNoise::half_window_m() const {
  return m_per_sample * (std::ceil(3 * width) + 2);
}

double read_variance_e2(const PulsedLidar& s) {
  return s.sensor.read_noise_e * s.sensor.read_noise_e;
}

double floor_variance_e2(const PulsedLidar& s) {
  return s.ambient_electrons + read_variance_e2(s) +
         s.sensor.gain_e_per_dn * s.sensor.gain_e_per_dn / 12;
}

}  // namespace scan::synth
