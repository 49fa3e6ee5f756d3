// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// By bisection of the incomplete gamma function's series.
#include "libscan/verify/chi_square.h"

#include <cmath>
#include <limits>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

// P(a, x) = x^a e^-x sum_k x^k / (a (a + 1) ... (a + k)) / Gamma(a) (DLMF 8.2.4 and 8.11.4).
double regularised_gamma(double a, double x) {
  double term = 1 / a, sum = term;
  for (double k = 1; term > std::numeric_limits<double>::epsilon() * sum; ++k) {
    term *= x / (a + k);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

}  // namespace

double chi_square_quantile(double share, double degrees) {
  if (!(degrees > 0) || !(share > 0) || !(share <= 0.9999))
    throw Error(Trouble::usage, "chi-square: share " + std::to_string(share) + " of " +
                                    std::to_string(degrees) + " degrees; must be in (0, 0.9999]" +
                                    " and above 0");
  // Beyond it lies less than 1e-4, whatever the degrees (Laurent and Massart 2000, lemma 1).
  double low = 0, high = degrees + 2 * std::sqrt(10 * degrees) + 2 * 10;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (regularised_gamma(degrees / 2, middle / 2) < share ? low : high) = middle;
  }
  return high;
}

}  // namespace scan
