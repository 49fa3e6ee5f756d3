// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The places of two overlapping Gaussians of known width.
#pragma once

#include <optional>

#include "libscan/acquire/gaussian_fit.h"

namespace scan::decoding {

struct GaussianPair {
  Gaussian first;
  Gaussian second;
  double first_sigma = 0;  // 1 sigma of first.centre, samples; the second's place is not known
};

// Maximum likelihood of centres and amplitudes as in fit_gaussian, the decomposition of a waveform
// (Wagner et al. 2006). None if it does not settle on two positive pulses in the order given.
std::optional<GaussianPair> fit_gaussian_pair(const Samples& samples, const GaussianPair& start);

}  // namespace scan::decoding
