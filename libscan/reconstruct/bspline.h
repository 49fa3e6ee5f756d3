// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Quadratic B-splines on a row of unit cells: values, slopes, and their exact integrals.
#pragma once

#include <array>
#include <vector>

namespace scan {

// The row has `cells` unit cells 0 ... cells-1 and the functions 0 ... cells+1; function i lives on
// the cells i-2, i-1 and i, so that the functions of cell k are k, k+1 and k+2.

// Values and slopes (per cell width) of the three functions of a cell at `t` in [0, 1].
template <class Real>
struct SplineWeights {
  std::array<Real, 3> value;
  std::array<Real, 3> slope;
};
template <class Real>
SplineWeights<Real> spline_weights(Real t) {
  const Real s = 1 - t;
  return {{s * s / 2, Real{0.5} + t * s, t * t / 2}, {-s, 1 - 2 * t, t}};
}

// Integrals over the row of the products of function i with the functions i-2 ... i+2: of the
// functions, of their first and of their second derivatives. Rows near the ends are cut by them:
// that makes the ends free.
struct StencilRow {
  std::array<double, 5> mass{};
  std::array<double, 5> stiffness{};
  std::array<double, 5> bending{};
};

// One row per function, followed by rows of zeros up to a multiple of `padded_to`.
std::vector<StencilRow> stencil_rows(int cells, int padded_to);

// A function of one level is the sum of the functions 2i-2 ... 2i+1 of the next, times these.
inline constexpr std::array<double, 4> refinement_mask = {0.25, 0.75, 0.75, 0.25};

}  // namespace scan
