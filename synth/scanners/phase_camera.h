// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A phase camera (amplitude-modulated continuous wave) with its light beside the lens.
#pragma once

#include <complex>
#include <vector>

#include "libscan/core/raw_frames.h"
#include "synth/detector.h"
#include "synth/ray_caster.h"
#include "synth/scanners/rendering.h"

namespace scan::synth {

// The light's distance law is the inverse square, its emission the same into every direction;
// ambient light comes from all sides. Decoders take phi = 4 pi f d / c with d along the pixel's ray
// from the lens. This is exact for emitter_offset_m = 0. Otherwise the path to the light is longer
// or shorter, and the decoded d differs from the true one by (|light - x| - |x|) / 2: to first
// order -emitter_offset_m / 2 times the x component of the ray's unit direction.
struct PhaseCamera {
  Camera camera;
  std::vector<double> frequencies_hz = {80e6};
  double electrons_at_1m =
      20000;                     // per tap: constant part of a white target facing the lens at 1 m
  double contrast = 0.5;         // amplitude over constant part, of the device's own light
  double ambient_electrons = 0;  // per tap, of a white target
  double emitter_offset_m = 0;  // of the light along camera x, for its shadow; the phase counts the
                                // true path from light to surface to lens
  int sub_rays = 1;             // per pixel side
  Sensor sensor;
  double max_range_m = 10;
};

void check(const PhaseCamera& scanner);

// Mean electrons of a pixel: tap k of frequency f is constant + Re(amplitude[f] exp(i k pi/2)), the
// phasor's argument being phi and its absolute value A. The mean over sub_rays^2 rays on a fixed
// grid; 0 where every ray meets nothing.
struct PixelPhasors {
  double constant_e = 0;
  std::vector<std::complex<double>> amplitude_e;  // one per frequency
};
PixelPhasors expected_phasors(const PhaseCamera& scanner, const RayCaster& caster,
                              const Pose& world_from_scanner, int column, int row);

Rendering render(const PhaseCamera& scanner, const RayCaster& caster,
                 const Pose& world_from_scanner, const RenderAddress& address,
                 const EffectSet& effects);
// Through the pixels' centres.
std::vector<RayTruth> true_rays(const PhaseCamera& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
