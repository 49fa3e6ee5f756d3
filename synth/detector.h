// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From expected electrons to digital numbers.
#pragma once

#include <cstdint>

#include "libscan/core/random.h"
#include "libscan/core/raw_frames.h"

namespace scan::synth {

// Which of the detector's effects are simulated.
struct DetectorEffects {
  bool shot_noise = true;
  bool read_noise = true;
  bool quantisation = true;  // off: the number is still whole, but of 1/64 of the least significant bit
};

// One reading: Poisson electrons, Gaussian read noise, saturation at the full well, gain, offset,
// rounding, clipping (EMVA 1288's linear model).
std::uint16_t read_pixel(const Sensor& sensor, const DetectorEffects& effects, double expected_e,
                         RandomStream& random);

}  // namespace scan::synth
