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
  double wavelength_m = 850e-9;  // that the scene's materials are seen at
  double electrons_at_1m =
      20000;                      // per tap: constant part of a white target facing the lens at 1 m
  double contrast = 0.5;          // amplitude over constant part, of the device's own light
  double ambient_electrons = 0;   // per tap, of a white target
  double electrons_per_w_m2 = 0;  // per tap, of a white target: irradiance by the scene's lights
  double emitter_offset_m = 0;  // of the light along camera x, for its shadow; the phase counts the
                                // true path from light to surface to lens
  // Wiggling: amplitudes of the correlation's 2nd, 3rd, ... harmonic over that of the first, in
  // phase with it (negative: opposed). Four taps cancel the even ones.
  std::vector<double> harmonics;
  // Motion: tap k of frequency f is exposed for an instant at (4 f + k) tap_interval_s less half of
  // the last one's time; the scanner moves at these constant velocities in its own frame and passes
  // its pose at time 0.
  double tap_interval_s = 0;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  double vignetting = 0;  // share of the cos^4 law that takes effect, 0 to 1
  double aperture_m = 0;  // defocus: diameter of a thin lens that is sharp on z = focus_m; its
  double focus_m = 1;     // blur is sampled by the sub-rays
  // Miscalibration: what is added to the distances of all pixels, as by a warm device, and the
  // standard deviation of a fixed pattern of pixels' own offsets.
  double range_offset_m = 0;
  double pixel_offset_m = 0;
  int sub_rays = 1;  // per pixel side; a pixel whose surroundings are even needs one alone
  Sensor sensor;
  double max_range_m = 10;
};

void check(const PhaseCamera& scanner);

// The device without the effects that are not in the set: their fields are those of an ideal one.
PhaseCamera with_effects(const PhaseCamera& scanner, const EffectSet& effects);

// Mean electrons of a pixel by the device's direct light: tap k of frequency f is constant + the
// sum over harmonics n of Re(amplitude exp(i n k pi/2)), the argument of the first phasor being phi
// and its absolute value A. The mean over sub_rays^2 rays on a fixed grid; 0 where every ray meets
// nothing.
struct PixelPhasors {
  double constant_e = 0;
  // [(n - 1) * frequencies + f]; so the first phasor of frequency f has the index f.
  std::vector<std::complex<double>> amplitude_e;
};
PixelPhasors expected_phasors(const PhaseCamera& scanner, const RayCaster& caster,
                              const Pose& world_from_scanner, int column, int row);

// Sub-rays are spent where light may vary within a pixel: where its central ray and its neighbours'
// show that the mean over its area may turn a phasor by more than 0.05 of a tap's noise, which is
// 0.07 of the range's, or change its brightness by more than 0.5 of it; and on textures. What is so
// thin that it escapes the pixels' centres is missed.
Rendering render(const PhaseCamera& scanner, const RayCaster& caster,
                 const Pose& world_from_scanner, const RenderAddress& address,
                 const EffectSet& effects);
// Through the pixels' centres and the middle of the lens, at time 0.
std::vector<RayTruth> true_rays(const PhaseCamera& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
