// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far a window that takes the surface for a plane is off where the surface is curved.
#pragma once

#include "libscan/core/image.h"

namespace scan::decoding {

// Least squares over a window of (2 half + 1)^2 px find the mean over it of what the disparity
// d(x, y) differs from its tangent plane, x^T H x / 2, all places weighing alike
// (long waves of texture weigh the outside more, up to 1.4 times the shift): the trace of H
// times the mean of x^2 over 2, that is (d_xx + d_yy) half (half + 1) / 6 (Schreier and Sutton
// 2002: subsets whose shape function is of too low an order). It is the same for every view of a
// place, so no number of scans averages it out.
struct WindowShift {
  double shift_px = 0;
  double own_share = 0;  // less this times the pixel's own disparity, which the shift holds
};

// By second differences over four times `half`. An axis counts nothing where the surface ends
// before that: at NaN, or a step of more than half a pixel per pixel.
WindowShift window_shift(const Image<float>& disparity_px, int column, int row, int half);

// What windows leave of a wave of the disparity along a row or a column, their bias taken away: the
// mean over the window (Dirichlet's kernel), and by how much the second differences above, of such
// means, raise it.
double window_transfer(double period_px, int half);

}  // namespace scan::decoding
