// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A small lidar, its expected waveforms and their moments.
#pragma once

#include <cmath>

#include "libscan/core/units.h"
#include "synth/scanners/pulsed_lidar_beam.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

inline constexpr double c = speed_of_light_m_s;

inline PulsedLidar small_lidar() {
  PulsedLidar lidar;
  lidar.pattern = RasterPattern{.rows = 6, .columns = 8, .height_rad = 0.3, .width_rad = 0.4};
  lidar.max_range_m = 30;
  return lidar;
}

// Fine steps instead of noise, so that only an effect is seen.
inline PulsedLidar quiet_lidar() {
  PulsedLidar lidar;
  lidar.pattern = RasterPattern{.rows = 10, .columns = 12, .height_rad = 0.2, .width_rad = 0.25};
  lidar.electrons_at_10m = 20000;
  lidar.ambient_electrons = 2;
  lidar.max_range_m = 40;
  lidar.sensor = {.gain_e_per_dn = 0.25, .offset_dn = 40, .read_noise_e = 4, .bits = 16};
  return lidar;
}

inline std::vector<double> waveform(const PulsedLidar& lidar, const Scene& scene,
                                    const Eigen::Vector3d& direction = Eigen::Vector3d::UnitZ()) {
  return expected_waveform(lidar, RayCaster(scene), Pose::Identity(), direction);
}

// Energy, mean time and variance of a waveform without its ambient light.
struct Moments {
  double electrons = 0;
  double time_s = 0;
  double variance_s2 = 0;
};

inline Moments moments_of(const PulsedLidar& lidar, const std::vector<double>& samples) {
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

inline Scene scene_of(Object object, double albedo) {
  return {.objects = {std::move(object)}, .materials = {plain(albedo)}};
}

}  // namespace scan::synth
