// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera (amplitude-modulated continuous wave) with its light beside the lens.
#pragma once

#include <vector>

#include "libscan/core/raw_frames.h"
#include "synth/detector.h"
#include "synth/ray_caster.h"
#include "synth/scanners/render_address.h"

namespace scan::synth {

struct PhaseCamera {
  Camera camera;
  std::vector<double> frequencies_hz = {80e6};
  double electrons_at_1m = 20000;  // per tap: constant part of a white target facing the lens at 1 m
  double contrast = 0.5;           // amplitude over constant part, of the device's own light
  double ambient_electrons = 0;    // per tap, of a white target
  double emitter_offset_m = 0;     // of the light along camera x, for its shadow; the phase counts the
                                   // true path from light to surface to lens
  int sub_rays = 1;                // per pixel side
  Sensor sensor;
  double max_range_m = 10;
};

void check(const PhaseCamera& scanner);
RawFrames render(const PhaseCamera& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const DetectorEffects& effects);
std::vector<RayTruth> true_rays(const PhaseCamera& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
