// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Light at a laser's stripe that is not the stripe's own, by a few paths and closed forms.
#pragma once

#include "synth/scanners/laser_line_paths.h"

namespace scan::synth {

// Means with three standard errors added, electrons.
struct StripeLight {
  double uneven_e = 0;  // the laser's, over two or more surfaces: brightest less darkest of three
                        // places, the middle and the ends of the window
  double elsewhere_e = 0;  // the same, brightest of eight places along the row, without errors
  double share_e = 0;      // the laser's over other ways than straight, at the middle
  double extra_m = 0;      // mean one-way extra length of that
  double others_e = 0;     // of the scene's lights, at the middle
};
StripeLight stripe_light(const LaserView& view, const LightTransport& transport,
                         const Eigen::Vector2d& pixel, double window_px, std::uint64_t index);

// What a medium scatters once into a view, `ray`, that crosses the sheet's middle at a point: the
// irradiance there times the chord of the Gaussian beam, the phase function and the scattering.
double veil_e(const LaserView& view, const Medium& medium, const CameraRay& ray,
              const Eigen::Vector3d& x_in_camera);

// How far from where it enters light leaves a translucent body.
struct Wander {
  double mean_m = 0;    // along the surface, the way the light came
  double spread_m = 0;  // root mean square
};
Wander wander_in(const Material& material, double sine_of_incidence);

}  // namespace scan::synth
