// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One small device of each kind, to be asked whether its stated uncertainty is honest. `light` is
// the share of the electrons that it collects as a rule.
#pragma once

#include "synth/scanner.h"

namespace scan::synth {

inline PhaseCamera stated_phase_camera(double light) {
  PhaseCamera s;
  s.camera = {
      .width_px = 80, .height_px = 60, .fx_px = 100, .fy_px = 100, .cx_px = 39.5, .cy_px = 29.5};
  s.frequencies_hz = {16e6, 80e6, 120e6};
  s.electrons_at_1m *= light;
  s.ambient_electrons = 2000;
  s.sensor = {.gain_e_per_dn = 2, .offset_dn = 50, .read_noise_e = 15, .bits = 16};
  return s;
}

inline PulsedLidar stated_lidar(double light) {
  PulsedLidar s;
  s.pattern = RasterPattern{.rows = 60, .columns = 80, .height_rad = 0.5, .width_rad = 0.7};
  s.electrons_at_10m *= light;
  s.sensor = {.gain_e_per_dn = 1, .offset_dn = 50, .read_noise_e = 5, .bits = 16};
  s.max_range_m = 30;
  return s;
}

// A stripe some six pixels wide: its pixels sample it without an error that matters.
inline LaserLine stated_laser_line(double light) {
  LaserLine s;
  s.camera = {
      .width_px = 160, .height_px = 60, .fx_px = 400, .fy_px = 400, .cx_px = 79.5, .cy_px = 29.5};
  s.beam_radius_m = 8e-4;
  s.steps = 31;
  s.step_m = 2e-3;
  s.peak_electrons *= light;
  s.sensor = {.gain_e_per_dn = 2, .offset_dn = 50, .read_noise_e = 10, .bits = 14};
  return s;
}

inline StereoPair stated_stereo_pair(double light) {
  StereoPair s;
  s.calibration = {.width_px = 160,
                   .height_px = 120,
                   .focal_px = 200,
                   .cx_px = 79.5,
                   .cy_px = 59.5,
                   .doffs_px = 4,
                   .baseline_m = 0.06,
                   .disparities_px = 48};
  s.ambient_electrons *= light;
  s.sensor = {.gain_e_per_dn = 12, .read_noise_e = 20, .bits = 8};
  return s;
}

inline Material printed() {
  return {.name = "printed", .bsdf = Lambert{0.9}, .texture = NoiseTexture{0.018, 2, 0.9}};
}

}  // namespace scan::synth
