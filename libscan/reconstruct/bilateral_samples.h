// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples moved to averages that stop at creases.
#pragma once

#include <optional>
#include <vector>

#include "libscan/reconstruct/samples.h"

namespace scan {

// What a fit says at its samples.
struct FittedSamples {
  std::vector<Eigen::Vector3d> feet;     // the places of its surface next to them
  std::vector<Eigen::Vector3d> normals;  // of the function at the samples, unit
  std::vector<double> length;            // smoothing length
  std::vector<double> trust;             // in the sample (ssd_fit.h)
};

// A fit of least squares takes a share of each wave and of each crease for noise, and leaves it in
// its residuals. Averaged over the same waves and added again they give it back (twicing, Tukey
// 1977), and if the average is over neighbours whose normals agree, creases too (bilateral filter,
// Tomasi and Manduchi 1998; on meshes Fleishman et al. 2003). Normals first, twice; then each
// sample moves along its own by the mean of (n_i + n_j) / 2 . (p_j - p_i), which is 0 on any
// sphere, so that curvature is not taken for noise. Weights are Tukey's biweight of the distance on
// the fit, to 3.2 times the upper quartile of its smoothing lengths or six spacings, and of the
// difference of normals. Where scatter is below a spacing and 1/sqrt(2) or half of that reach
// lowers the mean risk (local_smoothing.h) by 1 %, the regions where it does take it, and a sample
// that is more than half of its own shorter average goes to its foot. The samples it returns count
// as exact.
//
// Nothing where the mean risk is not below the fit's by 1 %, as on smooth surfaces with little
// noise; nor where scatter is below a tenth of a spacing, at which sharp_features.h needs no
// filter, or above two: there fits merge what lies side by side, and averages pull horns out of it.
std::optional<Samples> bilateral_samples(const Samples& samples, const FittedSamples& fit);

}  // namespace scan
