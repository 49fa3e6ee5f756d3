// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Smooth functions over a patch of pixels that see one surface, fitted to noisy values.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

namespace scan::synth {

struct PatchPlace {
  Eigen::Vector2d place_px;
  Eigen::Vector3d normal;  // unit, of what is seen there
};

// Orthonormal over the pixels, so a least-squares fit is functions * functions^T * values: the
// polynomials of the place degree by degree, with the normal's lean among the second. What a degree
// adds to a fit tells how far those below it fall short. What the pixels cannot tell apart is left
// out: a strip has fewer polynomials, a plane no lean.
struct PatchBasis {
  Eigen::MatrixXd functions;        // one row per pixel, one column per function
  std::vector<Eigen::Index> count;  // of functions up to degree 0, 1, ...
};
// At least to degree 1, for the rest as high, to 6, as leaves three pixels to a function.
PatchBasis patch_basis(std::span<const PatchPlace> places);

inline constexpr int patch_streams = 4;  // of independent values at each pixel

// The mean of the streams, and its variance by their scatter.
struct Spread {
  Eigen::ArrayXd mean, variance;
};
Spread spread_of(const std::array<Eigen::ArrayXd, patch_streams>& values);

// Least squares, each stream by itself: coefficients, a row per function, a column per signal.
struct PatchFit {
  PatchBasis basis;
  std::array<Eigen::MatrixXd, patch_streams> coefficients;
  // Of the first signal: the variance of a pixel's own mean by the streams' scatter, and the mean
  // square of the residuals of all functions beyond that; 0 unless it is significant.
  double pixel_chance = 0;
  double structure = 0;
};
// Of values with a row per pixel, a column per signal.
PatchFit fit_patch(PatchBasis basis, const std::array<Eigen::MatrixXd, patch_streams>& values);

}  // namespace scan::synth
