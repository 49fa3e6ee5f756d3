// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A stereo pair and a print for it to match.
#pragma once

#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

inline StereoPair pair_of_200_px() {
  StereoPair pair;
  pair.calibration = {.width_px = 200,
                      .height_px = 120,
                      .focal_px = 300,
                      .cx_px = 99.5,
                      .cy_px = 59.5,
                      .baseline_m = 0.06,
                      .disparities_px = 48};
  pair.sensor = {.gain_e_per_dn = 12, .read_noise_e = 5, .bits = 8};
  return pair;
}

// Texture of 8 px and more at 0.6 m.
inline Scene printed_plane(double tilt_rad) {
  Object wall = plane_at(0.6, tilt_rad);
  return {.objects = {wall},
          .materials = {
              {.name = "print", .bsdf = Lambert{0.9}, .texture = NoiseTexture{0.016, 1, 0.9}}}};
}

}  // namespace scan::synth
