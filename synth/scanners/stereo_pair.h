// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Two rectified cameras, with or without a random-dot projector.
#pragma once

#include <vector>

#include "libscan/core/raw_frames.h"
#include "synth/detector.h"
#include "synth/ray_caster.h"
#include "synth/scanners/rendering.h"

namespace scan::synth {

// Scanner frame = left camera. The scene is lit by ambient light from all sides without shadow
// plus, with projector_dots > 0, a projector midway between the cameras that casts shadows. Its
// field, as wide as the left image, is cut into square cells, projector_dots of them across; a
// fixed hash puts a dot into every second cell: radius 0.3 of the cell, somewhere inside it,
// brightest at its centre and fading smoothly to its rim. The images have 8 bits whatever the
// effects: without quantisation noise there is still rounding.
struct StereoPair {
  StereoCalibration calibration;
  double ambient_electrons = 3000;  // of a white pixel under ambient light
  double projector_electrons =
      0;                   // more, of a white pixel facing the projector at focus_m in a dot
  int projector_dots = 0;  // random dots across the projector's width
  double focus_m = 1;      // distance at which projector_electrons hold
  int sub_rays = 3;        // per pixel side
  Sensor sensor = {.gain_e_per_dn = 40, .read_noise_e = 10, .bits = 8};
};

enum class StereoSide { left, right };

void check(const StereoPair& scanner);

// Mean electrons of a pixel, averaged over its area by sub_rays^2 rays on a fixed grid, the same
// for both cameras; 0 where every ray meets nothing.
double expected_electrons(const StereoPair& scanner, const RayCaster& caster,
                          const Pose& world_from_scanner, StereoSide side, int column, int row);

Rendering render(const StereoPair& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects);
// Through the centres of the left pixels.
std::vector<RayTruth> true_rays(const StereoPair& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
