// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Speckle: how coherent light from a rough surface mottles the stripe.
//
// A pattern is the squared amplitude of a complex Gaussian field (Goodman 2007, ch. 3), smoothed by
// the lens. A round lens of diameter D gives the intensities' correlation (2 J1(v) / v)^2, v = pi x
// / grain, with a grain of lambda f / D in the image; here a Gaussian stands for it, exp(-v^2 / 4),
// which has the same curvature and the same area, 4 grain^2 / pi. Contrast below 1 is a mean over
// independent patterns (polarisation, wavelengths). Each step has patterns of its own: the stage
// moves the surface by more than a grain.
#pragma once

#include <span>

#include "synth/scanners/laser_line.h"

namespace scan::synth {

struct Speckle {
  double contrast = 0;                                 // of a point; 0: no speckle
  Eigen::Vector2d grain_px = Eigen::Vector2d::Ones();  // lambda f / D across columns and rows
};

// As the device has it: its fields, whatever is on.
Speckle speckle_of(const LaserLine& device);

// Contrast^2 of a pixel's mean over contrast^2 of a point: 1 / M along one axis for a pixel of side
// 1 (Goodman 2007, sec. 4.6).
double pixel_share(double grain_px);

// Multiplies row `row` of step `step` from column `first` on by the pixels' mean factors, of
// mean 1. Grains below a quarter of a pixel are so many that each pixel has a gamma variate of its
// own (Goodman 2007, eq. 4.138; neighbours' correlation, below 5 %, is left out); coarser ones are
// simulated.
void mottle(const Speckle& speckle, const RenderAddress& address, int step, int row, int first,
            std::span<double> row_e);

}  // namespace scan::synth
