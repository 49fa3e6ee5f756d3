// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples moved to averages that stop at creases, where these are proven nearer to the truth than a
// first fit.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "libscan/reconstruct/local_smoothing.h"

namespace scan {

// What a fit says at its samples.
struct FittedSamples {
  std::vector<double> residuals;         // signed distance from the surface
  std::vector<Eigen::Vector3d> normals;  // unit
  std::vector<double> length;            // smoothing length
  std::vector<double> trust;             // ssd_fit.h
};

struct BilateralSamples {
  Samples samples;             // those moved are on the surface: their sigma is 0
  std::vector<double> length;  // for a second fit: 0 for those moved
};

// A fit of least squares rounds off creases, or keeps noise beside them. Averages over neighbours
// whose normals agree do neither (bilateral filter, Tomasi and Manduchi 1998; on meshes Fleishman
// et al. 2003). Normals first, twice; then each sample moves along its own by the mean of (n_i +
// n_j) / 2 . (p_j - p_i), which is 0 on any sphere, so that curvature is not taken for noise.
// Weights are Tukey's biweight of the distance on the surface and of the normals' difference. Of
// two reaches and the fit itself a sample takes the one of least risk around it
// (local_smoothing.h), a reach only if the risk is below the fit's at the 1 % level: noise alone
// leaves the fit as it is. Reaches that smooth less than `least_length` are left out. Nothing where
// less than a tenth of the samples would move, and where scatter is wider than a spacing: which
// samples are neighbours on the surface is then unclear.
std::optional<BilateralSamples> bilateral_samples(const Samples& samples, const FittedSamples& fit,
                                                  const LocalSmoothing& regions,
                                                  double least_length);

}  // namespace scan
