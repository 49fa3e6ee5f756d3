// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How smooth the surface is to be, region by region: the smoothing length of least estimated risk.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libscan/reconstruct/samples.h"

namespace scan {

// Minimising sum_i w_i f(p_i)^2 + integral |D^2 f|^2 over a plane patch with rho samples per area
// answers a ripple of wave number k by 1 / (1 + (length k)^3), length^3 = 4 / (w rho): off the
// plane the best continuation is (1 + k|z|) exp(-k|z|), of energy 4 k^3 per squared amplitude.
// Integrating over all k gives what a sample weighs in its own value: the leverage, for area = 1 /
// rho. Integrating over the waves that cells of length / lengths_per_cell can hold gives, as a
// share of sigma^2, the posterior variance of the surface, which counts both the noise that is left
// and what smoothing takes (Wahba 1983).
inline constexpr double lengths_per_cell = 0.6;
double leverage(double area, double length);
double posterior_variance(double area, double length);

// Regions hold about 50 samples, more where scatter is wide, and share their sums with those
// around, as far as two smoothing lengths. A region's risk is the mean of r_i^2 + 2 sigma_i^2
// leverage_i (Mallows 1973; Stein 1981): up to a constant the expected squared distance of the fit
// from the truth at the samples. The leverage is that of a continuum: cells of 1.7 lengths cut its
// tail and leave half of it, so the noise a fit takes up counts twice. That inflation keeps chance,
// and scatter in position, which bends the fit more than linear theory says, from asking for
// lengths that are too short.
//
// A sample that scatters more than those around counts less: min(1, (s / sigma)^2), 1 / s the mean
// of 1 / sigma there. Weights that do not look at the residuals leave the sum a risk; without them
// a few samples beside edges, whose squares' chance goes as sigma^4, drown what the others tell.
class LocalSmoothing {
 public:
  explicit LocalSmoothing(const Samples& samples);

  // Takes the residuals of a fit with the length `trial`, each counted by its trust, and keeps it
  // where it lowered the risk. Returns the share of samples where it did.
  double judge(double trial, const std::vector<double>& residuals,
               const std::vector<double>& trust);
  // Per sample, the mean of such values' sizes around it.
  std::vector<double> mean_around(const std::vector<double>& values) const;
  // Per sample, whether such values sum up to more than 0 around it.
  std::vector<char> are_positive_around(const std::vector<double>& values) const;
  // What was kept, per sample; the logarithm goes smoothly from region to region.
  std::vector<double> lengths() const;

 private:
  void weigh();
  std::vector<double> around(const std::vector<double>& sums) const;

  const Samples& samples_;
  std::vector<std::uint32_t> region_of_;
  std::vector<std::array<std::int32_t, 27>> neighbours_;
  double region_width_ = 0;
  std::vector<double> weight_;  // per sample
  std::vector<double> risk_;    // sums over each region's samples
  std::vector<double> length_;
};

}  // namespace scan
