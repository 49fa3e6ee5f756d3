// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The kernel of block_detector.h, on raw arrays.
#pragma once

#include <cstdint>
#include <span>

namespace scan::synth {

// Of N Poisson electrons and Gaussian read noise the cumulants are kappa_1 = mean, kappa_2 = mean +
// sigma^2 and, of every higher order, the mean. With a normal number x in place of the quantile
// the expansion of Cornish and Fisher (1938; Abramowitz and Stegun 1964, 26.2.49) to the third
// order gives the sum. Without read noise the whole number next to it is N, and the variance is
// less by 1/12, what rounding adds (Sheppard).
struct ReadingLaw {
  enum class Kind {
    exact,  // the expectation itself
    sum,    // shot noise, or none, and read noise
    count   // shot noise alone
  };
  Kind kind = Kind::exact;
  double shot = 0;         // 1: there is shot noise, else 0
  double variance_e2 = 0;  // of the read noise
  double least_e = 0;      // where the law holds
  double most_e = 0;
  double low_e = 0;  // what lies outside is taken as these, where the law does not hold as well
  double high_e = 0;
  double dn_per_e = 0;
  double offset_dn = 0;
  double largest_dn = 0;
};

inline bool holds(const ReadingLaw& law, double expected_e) {
  return expected_e >= law.least_e && expected_e <= law.most_e;
}

// readings[i] of expected_e[i] by normals[i]. False if the law does not hold for all.
bool read_block(const ReadingLaw& law, std::span<const double> expected_e,
                std::span<const float> normals, std::span<std::uint16_t> readings);

// The versions that this processor can run.
using ReadingKernel = bool(const ReadingLaw& law, const double* expected_e, const float* normals,
                           std::uint16_t* readings, std::size_t count);
std::span<ReadingKernel* const> reading_kernels();

}  // namespace scan::synth
