// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where the rays of a stereo pair's pixels come from: lens, row and instant.
#pragma once

#include "synth/scanners/first_surface.h"
#include "synth/scanners/stereo_pair.h"

namespace scan::synth {

// The scanner as it is with those effects: what is off becomes ideal (no aperture, no motion, ...).
StereoPair with_effects(StereoPair scanner, const EffectSet& effects);

// Whether the device has anything of an effect of its own, noise aside.
bool has_effect(const StereoPair& scanner, Effect effect);

// Of sub-ray `i` of sub_rays^2, in the scanner frame at its own instant.
struct StereoRay {
  ScannerRay ray;
  double time_s = 0;  // after the middle of the exposure of the middle row
  double factor = 1;  // of the lens on the light: vignetting
};
StereoRay stereo_ray(const StereoPair& scanner, StereoSide side, int column, int row, int i);
// Of any place in the image, point of the unit disk that stands for the lens, and instant of the
// row's exposure, 0 to 1.
StereoRay stereo_ray(const StereoPair& scanner, StereoSide side, const Eigen::Vector2d& place,
                     const Eigen::Vector2d& on_lens, int row, double instant);

// Through the middle of the pinhole and the calibrated camera: what the decoder believes.
ScannerRay calibrated_ray(const StereoCalibration& calibration, StereoSide side,
                          const Eigen::Vector2d& place);

// Of the camera as it really stands.
Pose scanner_from_camera(const StereoPair& scanner, StereoSide side);

// scanner_from_moved: pose of the moving scanner in its own frame of time 0.
Pose moved(const StereoPair& scanner, double time_s);
bool is_moving(const StereoPair& scanner);

// Diameter of a point's image at depth z by a thin lens focused at focus_m, in pixels:
// aperture f |1 / z - 1 / focus|.
double blur_px(const StereoPair& scanner, double z_m);

// Electrons that the projector adds to a white surface that faces it at the place, nothing in
// between; scanner frame.
double projector_electrons(const StereoPair& scanner, const Eigen::Vector3d& x_in_scanner);

}  // namespace scan::synth
