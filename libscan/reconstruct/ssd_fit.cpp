// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_fit.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/median.h"
#include "libscan/reconstruct/local_smoothing.h"

namespace scan {
namespace {

constexpr double gradient_share = 0.1;
// Exact samples also give slopes, so that less than a spacing is of use.
constexpr double least_spacings = 0.4;
// A function that bends within the scatter passes through the samples one by one.
constexpr double least_sigmas = 1.5;
// A trial has only to tell which of two lengths is better.
constexpr double trial_residual = 0.03;
constexpr double least_share_lowered = 0.02;

class Fit {
 public:
  Fit(const OctreeGrid& grid, const Samples& samples, const SsdFitOptions& options)
      : samples_(samples),
        options_(options),
        levels_(grid.levels.size()),
        system_(grid, samples, weights(lengths_per_cell / grid.levels.front().cells())),
        solver_(system_, grid) {
    result_.solution.coefficients = active_arrays(grid);
  }

  // Down to lengths of `shortest`, as long as shorter ones are better somewhere.
  void search(double shortest, const Progress& progress) {
    LocalSmoothing smoothing(samples_);
    double trial = 2 * lengths_per_cell / (1 << coarsest_depth);
    for (std::size_t l = 0; l < levels_ || trial > 1.2 * shortest; ++l) {
      if (progress)
        progress("solve", static_cast<double>(l) / static_cast<double>(std::max(l, levels_) + 1));
      trial = std::max(trial / 2, shortest);
      if (l < levels_) system_.use_levels(l);
      solve(weights(trial), trial_residual);
      const double lowered = smoothing.judge(trial, system_.residuals(coefficients()));
      if (l + 1 >= levels_ && lowered < least_share_lowered) break;
    }
    result_.length = smoothing.lengths();
  }

  // On all levels with the lengths found.
  void finish() {
    system_.use_levels(levels_ - 1);
    solve(smoothing_weights(samples_, result_.length), options_.relative_residual);
    if (samples_.scattered_all_around) {
      system_.aim_at_scattered_mean(coefficients());
      improve(options_.relative_residual);
    }
    SsdSolution& solution = result_.solution;
    solution.relative_residual = solver_.relative_residual(coefficients());
    // The residual that conjugate gradients carries along drifts from the true one by rounding.
    if (solution.relative_residual <= 1.01 * options_.relative_residual)
      solution.stop = SolveStop::converged;
  }

  SsdFit take() { return std::move(result_); }

 private:
  LevelArrays& coefficients() { return result_.solution.coefficients; }

  SampleWeights weights(double length) const {
    return smoothing_weights(samples_, std::vector<double>(samples_.points.size(), length));
  }

  void solve(SampleWeights weights, double relative_residual) {
    system_.set_weights(std::move(weights));
    solver_.refresh();
    improve(relative_residual);
  }

  void improve(double relative_residual) {
    result_.solution.iterations += solver_.improve(
        relative_residual, options_.max_iterations - result_.solution.iterations, coefficients());
  }

  const Samples& samples_;
  SsdFitOptions options_;
  std::size_t levels_;
  SsdSystem system_;
  SsdSolver solver_;
  SsdFit result_;
};

}  // namespace

SampleWeights smoothing_weights(const Samples& samples, const std::vector<double>& length) {
  SampleWeights weights;
  for (std::size_t i = 0; i < length.size(); ++i) {
    const double l = std::max(length[i], least_spacings * std::sqrt(samples.area[i]));
    weights.value.push_back(4 * samples.area[i] / (l * l * l));
    weights.gradient.push_back(gradient_share * l * l * weights.value.back());
  }
  return weights;
}

SsdFit fit_surface(const OctreeGrid& grid, const Samples& samples, const SsdFitOptions& options,
                   const Progress& progress) {
  Fit fit(grid, samples, options);
  const double chosen = std::max(least_spacings * std::sqrt(median(samples.area)),
                                 least_sigmas * median(samples.sigma));
  fit.search(options.length > 0 ? options.length : chosen, progress);
  fit.finish();
  if (progress) progress("solve", 1);
  return fit.take();
}

}  // namespace scan
