// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A small phase camera and what its readings mean.
#pragma once

#include <cmath>

#include "libscan/core/units.h"
#include "synth/scanners/phase_light.h"
#include "tests/synth/scanner_scenes.h"

namespace scan::synth {

using Phasor = std::complex<double>;

inline PhaseCamera small_camera() {
  PhaseCamera camera;
  camera.camera = {
      .width_px = 48, .height_px = 32, .fx_px = 60, .fy_px = 60, .cx_px = 23.5, .cy_px = 15.5};
  camera.frequencies_hz = {16e6, 80e6, 120e6};
  return camera;
}

inline Eigen::Vector3d direction_of(const PhaseCamera& s, int column, int row) {
  return Eigen::Vector3d((column - s.camera.cx_px) / s.camera.fx_px,
                         (row - s.camera.cy_px) / s.camera.fy_px, 1)
      .normalized();
}

inline PixelPhasors light_at(const PhaseCamera& camera, const Scene& scene, int column, int row) {
  return expected_phasors(camera, RayCaster(scene), Pose::Identity(), column, row);
}

inline PhaseTaps taps_of(const PhaseCamera& camera, const Scene& scene, const EffectSet& effects,
                         const RenderAddress& address = {}) {
  return std::get<PhaseTaps>(
      render(camera, RayCaster(scene), Pose::Identity(), address, effects).frames);
}

// phi = 4 pi f d / c of physics 7.5.
inline double phase_of(double frequency_hz, double distance_m) {
  return 4 * std::numbers::pi * frequency_hz * distance_m / speed_of_light_m_s;
}

// The angle between a phasor and a phase, rad.
inline double angle_between(const Phasor& phasor, double phase) {
  return std::abs(std::arg(phasor * std::polar(1.0, -phase)));
}

// (C3 - C1) + ... = 2 A exp(i phi) of C_k = B + A cos(phi + k pi / 2).
inline Phasor decode(const PhaseTaps& frames, std::size_t frequency, std::size_t pixel) {
  const auto tap = [&](int k) {
    return static_cast<double>(frames.taps[frequency][k].pixels[pixel]);
  };
  return {tap(0) - tap(2), tap(3) - tap(1)};
}

// One pixel whose field of 1e-6 rad looks along the axis.
inline PhaseCamera one_pixel(double frequency_hz = 80e6) {
  PhaseCamera camera;
  camera.camera = {.width_px = 1, .height_px = 1, .fx_px = 1e6, .fy_px = 1e6};
  camera.frequencies_hz = {frequency_hz};
  return camera;
}

// Mean of a tap.
inline double mean_tap(const PhaseCamera& camera, const PixelPhasors& light, int frequency,
                       int tap) {
  const std::vector<Tone> tones = tones_of(camera);
  double mean = light.constant_e;
  for (std::size_t t = 0; t < tones.size(); ++t)
    if (tones[t].frequency == frequency)
      mean += modulation(light.amplitude_e[t], tones[t].harmonic, tap);
  return mean;
}

}  // namespace scan::synth
