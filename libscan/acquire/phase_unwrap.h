// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The one distance that phases of several frequencies agree on.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace scan::decoding {

// Distance modulo the half wavelength of one frequency.
struct FoldedDistance {
  double distance_m = 0;  // in [0, period_m)
  double sigma_m = 0;
  double period_m = 0;  // c / 2f
};

struct UnwrappedDistance {
  std::string_view miss = {};  // why there is none; then the rest is void
  double distance_m = 0;
  double sigma_m = 0;
};

// Range after which the phases of all the frequencies repeat, c / (2 gcd f_i), metres; frequencies
// are taken to whole hertz.
double combined_period_m(std::span<const double> frequencies_hz);

// Maximum likelihood over the wrap counts: all distances in [0, range_m] that the most precise
// frequency allows are rated by the chi-square of all frequencies. One that disagrees by
// more than `gate_sigmas`: inconsistent. A second one with a chi-square within gate_sigmas^2 of the
// best: ambiguous. A distance that noise may have carried over either end of the range is a
// candidate at both, so that a fold at the border is never taken silently.
UnwrappedDistance unwrap(std::span<const FoldedDistance> folded, double range_m,
                         double gate_sigmas);

}  // namespace scan::decoding
