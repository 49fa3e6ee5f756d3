// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/detector.h"

#include <algorithm>
#include <cmath>

namespace scan::synth {

DetectorEffects detector_effects(const EffectSet& effects) {
  return {.shot_noise = effects.has(Effect::shot_noise),
          .read_noise = effects.has(Effect::read_noise),
          .quantisation = effects.has(Effect::quantisation)};
}

Sensor delivered_sensor(const Sensor& sensor, const DetectorEffects& effects) {
  if (effects.quantisation) return sensor;
  const int more_bits = std::min(6, 16 - sensor.bits);
  Sensor finer = sensor;
  finer.gain_e_per_dn = std::ldexp(sensor.gain_e_per_dn, -more_bits);
  finer.offset_dn = std::ldexp(sensor.offset_dn, more_bits);
  finer.bits = sensor.bits + more_bits;
  return finer;
}

std::uint16_t read_pixel(const Sensor& sensor, const DetectorEffects& effects, double expected_e,
                         RandomStream& random) {
  double electrons = effects.shot_noise ? static_cast<double>(random.poisson(expected_e))
                                        : std::max(expected_e, 0.0);
  electrons = std::min(electrons, sensor.full_well_e);
  if (effects.read_noise && sensor.read_noise_e > 0)
    electrons += sensor.read_noise_e * random.normal();
  const Sensor delivered = delivered_sensor(sensor, effects);
  const double dn = electrons / delivered.gain_e_per_dn + delivered.offset_dn;
  const double largest = (1 << delivered.bits) - 1;
  return static_cast<std::uint16_t>(std::round(std::clamp(dn, 0.0, largest)));
}

}  // namespace scan::synth
