// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Raw readings for the tests: expected electrons to digital numbers, with or without chance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "libscan/core/random.h"
#include "libscan/core/raw_frames.h"

namespace scan::test {

inline std::uint16_t digitise(const Sensor& sensor, double electrons) {
  const double dn =
      std::min(electrons, sensor.full_well_e) / sensor.gain_e_per_dn + sensor.offset_dn;
  return static_cast<std::uint16_t>(std::clamp(std::round(dn), 0.0, std::exp2(sensor.bits) - 1));
}

// Shot and read noise on top.
inline std::uint16_t noisy(const Sensor& sensor, double expected_e, RandomStream& random) {
  return digitise(sensor, static_cast<double>(random.poisson(expected_e)) +
                              sensor.read_noise_e * random.normal());
}

inline double bell(double x, double sigma) {
  return std::exp(-x * x / (2 * sigma * sigma));
}

// Sum over `count` trials of (error / reported sigma)^2 has mean `count` and variance 2 count if
// the sigma is right and the errors normal: its mean over the trials must lie within 1 +- 4 sqrt(2
// / count), plus `model` for the stated approximation of the method.
inline double chi_square_margin(double count, double model = 0) {
  return 4 * std::sqrt(2 / count) + model;
}

}  // namespace scan::test
