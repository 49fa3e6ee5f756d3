// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera's taps: when each is exposed, and the light that it collects.
#pragma once

#include <vector>

#include "synth/scanners/phase_light.h"

namespace scan::synth {

// What may be left out of a pixel's light, in a tap's noise: of its phasors across their length, of
// its brightness.
inline constexpr double turning_share = 0.05;
inline constexpr double brightness_share = 0.5;

// Taps that are exposed at one instant: one, or all.
struct Exposure {
  double time_s = 0;
  int frequency = -1;  // -1: all taps of all frequencies
  int tap = 0;
};
// One for all taps of a scanner that does not move, else one for each.
std::vector<Exposure> exposures_of(const PhaseCamera& scanner);
// The scanner's pose at that time.
Pose moved(const Pose& world_from_scanner, const PhaseCamera& scanner, double time_s);

// Tones that the exposure's taps respond to.
std::vector<Tone> tones_of(const PhaseCamera& scanner, const Exposure& exposure);

// Of the pixels of some rows, row by row.
struct LightImage {
  std::size_t tones = 0;
  std::size_t refined_pixels = 0;  // that got all their sub-rays
  std::vector<double> constant_e;
  std::vector<std::complex<double>> amplitude_e;  // [pixel * tones + tone]

  LightImage(std::size_t pixels, std::size_t tone_count)
      : tones(tone_count), constant_e(pixels), amplitude_e(pixels * tone_count) {}
  LightSum at(std::size_t pixel) {
    return {constant_e[pixel], std::span(amplitude_e).subspan(pixel * tones, tones)};
  }
};

struct Rows {
  int begin = 0;
  int end = 0;
};
// The device's direct light in these rows, the sub-rays spent where render() says.
LightImage direct_light(const PhaseCamera& scanner, std::span<const Tone> tones,
                        const RayCaster& caster, const Pose& world_from_scanner, const Rows& rows);

// Variance of a tap's reading with all of the detector's noises, electrons^2.
double tap_variance_e2(const Sensor& sensor, double mean_e);

}  // namespace scan::synth
