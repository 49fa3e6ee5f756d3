// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether points know their own uncertainty: mean normalised error squared (1 is honest) and the
// share inside the stated 95 % interval, for each kind of scanner, target and light, over seeds;
// then planes near and far and oblique.
// Behind each the standard deviation of the mean, taken between seeds, since points of one scan may
// share their errors; last the bias over the root mean square of the error along the ray. "+rim" is
// the ball with the points whose windows look past its rim, which stereo's edge margin drops.
//
// uncertainty_study [seeds]; 20 without an argument.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/validation/stated_scanners.h"
#include "tests/verify/figure.h"

namespace scan::synth {
namespace {

struct Spread {
  double mean = 0, of_mean = 0;
};

Spread spread_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  for (const double value : values) squares += (value - sum / n) * (value - sum / n);
  return {sum / n, std::sqrt(squares / (n - 1) / n)};
}

void study(const StatedScanner& of, std::size_t seeds) {
  std::vector<double> squares, shares, biases;
  double points = 0;
  for (std::size_t seed = 1; seed <= seeds; ++seed) {
    const auto figures = stated_figures(of, seed);
    const double rms = figure(figures, "normalised_range_error_rms");
    squares.push_back(rms * rms);
    shares.push_back(figure(figures, "range_error_within_95"));
    biases.push_back(figure(figures, "range_error_bias") / figure(figures, "range_error_rms"));
    points += static_cast<double>(measurement(figures, "range_error_within_95").count);
  }
  const Spread square = spread_of(squares), share = spread_of(shares), bias = spread_of(biases);
  std::printf("%-11s %-13s %5.1f %9.0f   %6.3f +- %.3f   %6.2f +- %.2f %%   %6.3f\n",
              of.device.c_str(), of.target.c_str(), of.light, points, square.mean, square.of_mean,
              100 * share.mean, 100 * share.of_mean, bias.mean);
  std::fflush(stdout);
}

}  // namespace
}  // namespace scan::synth

int main(int argc, char** argv) {
  const std::size_t seeds = argc > 1 ? std::max(2ul, std::strtoul(argv[1], nullptr, 10)) : 20;
  std::printf(
      "scanner     target        light    points   e' C^-1 e          inside 95 %%        "
      "bias/rms\n");
  for (const auto& scanner : scan::synth::stated_scanners()) scan::synth::study(scanner, seeds);
  for (const auto& scanner : scan::synth::stated_poses()) scan::synth::study(scanner, seeds);
}
