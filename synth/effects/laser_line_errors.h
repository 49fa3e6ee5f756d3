// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far an effect can move a laser line's range: closed forms at one point of the stripe.
#pragma once

#include "synth/effects/effect.h"
#include "synth/scanners/laser_line_speckle.h"

namespace scan::synth {

// Where the middle of the sheet is seen.
struct StripePoint {
  double range_m = 0;  // from the camera
  double depth_m = 0;  // along its axis
  double from_laser_m = 0;
  double m_per_px = 0;        // change of range, on the light plane, by a pixel along the row
  double px_per_m = 0;        // shift of the stripe by a shift of the light plane along its normal
  double radius_m = 0;        // of the beam there, as the device has it
  double height_e = 0;        // peak of the stripe
  double other_e = 0;         // light of others there
  double rest_of_view_m = 0;  // largest change of range on the light plane within the image's row
  // Of what the pixels around see, from the stripe's tangent plane: how far its range lies off, and
  // whether anything there is another surface, of another colour or missing.
  double step_m = 0;
  bool near_edge = false;
  double uneven_e = 0;      // the laser's light over two or more surfaces, differs in the window
  double elsewhere_e = 0;   // the same, brightest of the row
  bool met_smooth = false;  // the scene has a mirror or clear body
  double wander_m = 0;      // along the surface, mean, of light that comes back out of a body
  double spread_m = 0;      // and its root mean square distance
  double veil_e = 0;        // what fog scatters into the view in front of the surface
  double lost_in_fog = 0;   // optical depth of both ways
};

// On either side of its centre, what a decoder takes a stripe's place from.
double window_px(double stripe_sigma_px);

// 1 sigma of the stripe in its row, with the pixel's own box.
double stripe_sigma_px(const StripePoint& point);

// 1 sigma of range by shot, read and rounding noise.
double noise_m(const LaserLine& device, const StripePoint& point);

// 1 sigma of the centre, px, of a Gaussian stripe of that sigma in a row of pixels, by speckle.
double speckle_sigma_px(const Speckle& speckle, double stripe_px);

// Range error at most (three sigma of noises) if the effect is left out; 0 where the device is
// ideal.
double left_out_m(const LaserLine& device, const StripePoint& point, Effect effect);

}  // namespace scan::synth
