// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Quantiles of the chi-square distribution.
#pragma once

namespace scan {

// The value that a chi-square variable of so many degrees of freedom does not exceed with the
// probability `share`; to rounding for some degrees, to 1e-6 of it for a thousand million. Throws
// scan::Error (usage) unless degrees > 0 and 0 < share <= 0.9999.
double chi_square_quantile(double share, double degrees);

}  // namespace scan
