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
  double focus_m = 1;      // distance at which projector_electrons hold and lenses are sharp
  int sub_rays = 3;        // per pixel side; they share pixel, lens and exposure among them
  Sensor sensor = {.gain_e_per_dn = 40, .read_noise_e = 10, .bits = 8};
  double wavelength_m = 550e-9;
  double electrons_per_w_m2 = 1000;  // of a white pixel, by the scene's lights
  // Both lenses. A thin lens blurs a point at depth z over aperture_m f |1 / z - 1 / focus| pixels.
  double aperture_m = 0;  // diameter; 0: a pinhole
  double vignetting = 0;  // 0 to 1: share of the cos^4 law of natural vignetting
  // What the calibration does not know of the right camera, in the scanner frame.
  Eigen::Vector3d right_rotation_error_rad = Eigen::Vector3d::Zero();  // axis times angle
  Eigen::Vector3d right_position_error_m = Eigen::Vector3d::Zero();
  // The pair moves along with these velocities (scanner frame) while rows are exposed one after the
  // other, each for exposure_s. The truth is that of the middle row's middle.
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  double row_time_s = 0;  // from one row to the next
  double exposure_s = 0;
};

enum class StereoSide { left, right };

void check(const StereoPair& scanner);

// Mean electrons of a pixel by direct light of device and surroundings (the ambient light, not the
// scene's lights), averaged over sub_rays^2 rays on a fixed grid, the same for both cameras; 0
// where every ray meets nothing.
double expected_electrons(const StereoPair& scanner, const RayCaster& caster,
                          const Pose& world_from_scanner, StereoSide side, int column, int row);

Rendering render(const StereoPair& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects);
// Through the centres of the left pixels.
std::vector<RayTruth> true_rays(const StereoPair& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
