// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples moved to averages that stop at creases, where these are nearer to the truth than a fit.
#pragma once

#include <optional>
#include <vector>

#include "libscan/reconstruct/samples.h"

namespace scan {

// What a fit says at its samples.
struct FittedSamples {
  std::vector<double> residuals;         // signed distance from the surface
  std::vector<Eigen::Vector3d> normals;  // unit
  std::vector<double> length;            // smoothing length
  std::vector<double> trust;             // in the sample (ssd_fit.h)
};

// A fit of least squares rounds off creases, or keeps noise beside them. Averages over neighbours
// whose normals agree do neither (bilateral filter, Tomasi and Manduchi 1998; on meshes Fleishman
// et al. 2003). Normals first, twice; then each sample moves along its own by the mean of (n_i +
// n_j) / 2 . (p_j - p_i), which is 0 on any sphere, so that curvature is not taken for noise.
// Weights are Tukey's biweight of the distance on the surface, to six spacings, and of the
// difference of normals. The samples it returns count as exact.
//
// Nothing where the mean risk (local_smoothing.h) is not below the fit's by 2 %, as on smooth
// surfaces, whose fits are smoother; nor where scatter is below a tenth of a spacing, at which
// sharp_features.h needs no filter, or above one: who is next to whom on the surface is then
// unclear.
std::optional<Samples> bilateral_samples(const Samples& samples, const FittedSamples& fit);

}  // namespace scan
