// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/scanners/pulsed_lidar_fog.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libscan/core/parallel.h"
#include "libscan/core/units.h"

namespace scan::synth {
namespace {

constexpr double pulse_reach_sigmas = 9;

}  // namespace

LidarFog::LidarFog(const PulsedLidar& s, const Medium& medium, const SampleAxis& axis)
    : target_(soft_target(medium, s.electrons_at_10m * 100, s.overlap_m)),
      pulse_sigma_s_(s.pulse_sigma_s),
      axis_(axis),
      endless_e_(static_cast<std::size_t>(axis.samples)) {
  parallel_for(endless_e_.size(), [&](std::size_t i) {
    endless_e_[i] = returned_e(i, std::numeric_limits<double>::infinity());
  });
}

double LidarFog::returned_e(std::size_t sample, double far_m) const {
  const double begin_s = axis_.start_s + (static_cast<double>(sample) - 0.5) * axis_.interval_s;
  return soft_target_electrons(target_, far_m, pulse_sigma_s_, begin_s, begin_s + axis_.interval_s);
}

void LidarFog::dim(std::span<Echo> echoes) const {
  for (Echo& echo : echoes)  // the way there and back is c times the time
    echo.electrons *= std::exp(-target_.extinction_per_m * speed_of_light_m_s * echo.time_s);
}

SampleRange LidarFog::add(double far_m, std::span<double> samples) const {
  const auto count = static_cast<double>(samples.size());
  const double reach = pulse_reach_sigmas * pulse_sigma_s_ / axis_.interval_s + 0.5;
  const double end = (2 * far_m / speed_of_light_m_s - axis_.start_s) / axis_.interval_s;
  const auto whole = static_cast<std::size_t>(std::clamp(std::floor(end - reach), 0.0, count));
  const auto behind = static_cast<std::size_t>(std::clamp(std::ceil(end + reach), 0.0, count));
  for (std::size_t i = 0; i < whole; ++i) samples[i] += endless_e_[i];
  for (std::size_t i = whole; i < behind; ++i) samples[i] += returned_e(i, far_m);
  return {0, behind};
}

}  // namespace scan::synth
