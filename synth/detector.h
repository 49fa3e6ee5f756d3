// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From expected electrons to digital numbers.
#pragma once

#include <cstdint>

#include "libscan/core/random.h"
#include "libscan/core/raw_frames.h"
#include "synth/effects/effect.h"

namespace scan::synth {

// Which of the detector's effects are simulated.
struct DetectorEffects {
  bool shot_noise = true;
  bool read_noise = true;
  bool quantisation = true;  // off: see delivered_sensor
};

DetectorEffects detector_effects(const EffectSet& effects);

// The sensor whose numbers read_pixel delivers, to be handed on in the frames' calibration. Without
// quantisation the steps are 64 times finer (a pixel stays a whole number), or as much as 16 bits
// hold.
Sensor delivered_sensor(const Sensor& sensor, const DetectorEffects& effects);

// One reading: Poisson electrons, saturation at the full well, Gaussian read noise, gain, offset,
// rounding, clipping (EMVA 1288's linear model). `sensor` is the nominal one. Draws from `random`
// only what the effects need, and no shot noise of zero electrons.
std::uint16_t read_pixel(const Sensor& sensor, const DetectorEffects& effects, double expected_e,
                         RandomStream& random);

}  // namespace scan::synth
