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
  double footprint_m = 0;     // largest minus smallest range within the pixel
  double indirect_share = 0;  // of height_e
  bool met_smooth = false;    // a mirror or clear body stands in the way of view or light
  double wander_m = 0;        // mean free path of transport in the most translucent body
  double extinction_per_m = 0;  // of the medium around
};

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
