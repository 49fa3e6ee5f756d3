// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A laser-line triangulation scanner on a stage or turntable.
#pragma once

#include <vector>

#include "libscan/core/raw_frames.h"
#include "synth/detector.h"
#include "synth/ray_caster.h"
#include "synth/scanners/rendering.h"

namespace scan::synth {

// The scanner frame is the camera's frame at the middle of the sweep. The laser stands at
// (baseline_m, 0, 0) of the camera frame; its plane contains the camera's y direction and is turned
// by triangulation_rad from the optical axis towards it: it crosses the axis at z = baseline /
// tan(triangulation), the focus.
//
// The light falls off with the inverse distance from the laser (a fan spreads in one direction) and
// with the beam's growing thickness; surfaces reflect it as their BSDF says; light and view may be
// obstructed.
struct LaserLine {
  Camera camera;
  double baseline_m = 0.1;
  double triangulation_rad = 0.5;
  double fan_rad = 0.8;         // full opening of the laser's fan
  double beam_radius_m = 1e-4;  // 1/e^2 radius of the Gaussian across the plane, at the focus
  double peak_electrons =
      5000;  // at the stripe's centre on a white target facing the camera, at focus
  // Either the head moves by `step_m` along `stage_direction` (camera frame), or, with a turn_rad
  // other than 0, it turns about an axis (a point and a direction in the camera frame) by
  // `turn_rad` per step, as a turntable does.
  int steps = 200;
  double step_m = 5e-4;
  Eigen::Vector3d stage_direction = Eigen::Vector3d::UnitX();
  double turn_rad = 0;
  Eigen::Vector3d turn_axis = Eigen::Vector3d::UnitY();
  Eigen::Vector3d turn_centre_m = Eigen::Vector3d::Zero();
  int sub_rays = 1;  // per pixel side
  Sensor sensor;
  double min_range_m = 0;
  double max_range_m = 1e9;
  // What a real device has besides; 0 is the ideal one, and each obeys its effect.
  double wavelength_m = 650e-9;
  double beam_quality = 0;        // beam_spread: M^2 >= 1; 0: equally thick everywhere
  double plane_bow_m = 0;         // plane_bow: sag along the normal at the fan's ends, at the focus
  double plane_shift_m = 0;       // miscalibration: the real laser stands so far along the normal
  double plane_turn_rad = 0;      // and its real triangulation angle is larger by this
  double aperture_m = 0;          // diameter of the camera's lens: defocus, speckle; 0: a pinhole
  double lens_focus_m = 0;        // depth of sharp images; 0: that of the laser's focus
  double speckle_contrast = 0;    // of a point: 1 coherent and polarised, 0 incoherent light
  double exposure_share = 0;      // motion: of a step, during which the shutter is open
  double blooming_share = 0;      // of charge above the full well; the rest goes down a drain
  double ambient_electrons = 0;   // scene_lights: of a white surface, per exposure
  double electrons_per_w_m2 = 0;  // scene_lights: of a white surface under that irradiance
};

// Throws scan::Error (input) naming field, value and limit.
void check(const LaserLine& scanner);
// StripeImages.
Rendering render(const LaserLine& scanner, const RayCaster& caster, const Pose& world_from_scanner,
                 const RenderAddress& address, const EffectSet& effects);
// The true ray of (row, step): where the middle of the light plane meets the surface, lit and seen,
// in that camera row, that is on the curve of views through the centres of its pixels (with
// distortion no plane); of several such points the one nearest to the camera. Normals face the
// laser. The plane is the calibrated one: what bow and miscalibration move shows as an error.
std::vector<RayTruth> true_rays(const LaserLine& scanner, const RayCaster& caster,
                                const Pose& world_from_scanner);

}  // namespace scan::synth
