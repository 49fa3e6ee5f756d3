// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_fit.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/median.h"
#include "libscan/reconstruct/local_smoothing.h"

namespace scan {
namespace {

// Points scattered to both sides of the surface pull f flat: this keeps its slope.
constexpr double slope_share = 0.03;
// The mean square of f over a flat square patch of the sample's area is f^2 + |slope|^2 area / 12.
constexpr double patch_share = 1.0 / 12;
// The scatter, in spacings, from which on normals tell no more than the points.
constexpr double exact_sigma = 0.02;
constexpr double least_spacings = 0.4, least_spacings_exact = 0.2;
// A function that bends within the scatter passes through the samples one by one.
constexpr double least_sigmas = 1;
// So much of the solution's energy norm moves the surface by less than scatter, or cells, do.
// Sums in floats leave a residual below a third of this (tests/reconstruct/ssd_solver_test.cpp).
constexpr double least_residual_in_floats = 1e-4;
constexpr double residual_of_scattered = 5e-3, residual_of_exact = 1e-3;
// Residuals within one of these are nothing strange: scatter; what is lost between samples; what a
// fit of that length rounds off an edge; what the samples around leave on average.
constexpr double tolerated_sigmas = 4, tolerated_spacings = 0.5, tolerated_lengths = 0.5;
constexpr double tolerated_means = 2;
constexpr double judged_spacings = 10;
// Scatter in all directions has flattened the first solution, whose Laplacian is too small; that of
// the second is right to the next order in scatter: 3 % nearer on the bunny with 1 % noise, nothing
// on smooth shapes.
constexpr int rounds_of_aim = 2;
// A trial has only to tell which of two lengths is better; at three times this what the solver
// leaves decides, and surfaces with noise are up to 4 % farther off.
constexpr double trial_residual = 0.01;
constexpr double least_share_lowered = 0.02;

// One for exact samples, nothing for scattered ones.
double exactness(double area, double sigma) {
  return std::max(0.0, 1 - sigma * sigma / (exact_sigma * exact_sigma * area));
}

// Exact samples also give slopes, so that a fifth of a spacing is of use.
double least_length(double area, double sigma) {
  const double spacings = std::lerp(least_spacings, least_spacings_exact, exactness(area, sigma));
  return spacings * std::sqrt(area);
}

bool is_exact(const Samples& samples) {
  return exactness(median(samples.area), median(samples.sigma)) > 0;
}

template <class Real>
class Fit {
 public:
  Fit(const OctreeGrid& grid, const Samples& samples, const SsdFitOptions& options)
      : samples_(samples),
        options_(options),
        levels_(grid.levels.size()),
        trust_(samples.points.size(), 1.0),
        smoothing_(samples),
        system_(grid, samples, smoothing_weights(samples, even(length_at(0)), trust_)),
        solver_(system_, grid) {
    result_.solution.coefficients = active_arrays(grid);
  }

  // The least length everywhere; a start from the coarser levels.
  void start(const Progress& progress) {
    result_.length.assign(samples_.points.size(), options_.length);
    for (std::size_t l = 0; l + 1 < levels_; ++l) {
      report(progress, l);
      system_.use_levels(l);
      const double trial = std::max(length_at(l), options_.length);
      solve(even(trial), trial_residual);
      distrust(system_.residuals(coefficients()), trial);
    }
  }

  // Down to the least length, as long as shorter ones are better somewhere.
  void search(const Progress& progress) {
    for (std::size_t l = 0; l < levels_ || length_at(l - 1) > 1.2 * options_.length; ++l) {
      report(progress, l);
      const double trial = std::max(length_at(l), options_.length);
      const bool coarse = l + 1 < levels_;
      if (l < levels_) system_.use_levels(l);
      const LevelArrays before = coarse ? LevelArrays{} : coefficients();
      solve(even(trial), trial_residual);
      const std::vector<double> residuals = system_.residuals(coefficients());
      distrust(residuals, trial);
      const double lowered = smoothing_.judge(trial, residuals, trust_);
      if (!coarse && lowered < least_share_lowered) {
        coefficients() = before;  // of the length that most samples keep: a start nearer to the end
        break;
      }
    }
    result_.length = smoothing_.lengths();
  }

  // On all levels with the lengths found.
  void finish() {
    system_.use_levels(levels_ - 1);
    solve(result_.length, options_.relative_residual);
    const int rounds = samples_.scattered_all_around && !is_exact(samples_) ? rounds_of_aim : 0;
    for (int round = 0; round < rounds; ++round) {
      system_.aim_at_scattered_mean(coefficients());
      improve(options_.relative_residual);
    }
    SsdSolution& solution = result_.solution;
    solution.relative_residual = solver_.relative_residual(coefficients());
    // The residual that conjugate gradients carries along drifts from the true one by rounding.
    if (solution.relative_residual <= 1.01 * options_.relative_residual)
      solution.stop = SolveStop::converged;
  }

  SsdFit take() {
    result_.trust = std::move(trust_);
    return std::move(result_);
  }

 private:
  // In step with the cells of level l, and on past the finest level.
  static double length_at(std::size_t l) {
    return std::ldexp(lengths_per_cell, -coarsest_depth - static_cast<int>(l));
  }

  void report(const Progress& progress, std::size_t l) const {
    if (progress)
      progress("solve", static_cast<double>(l) / static_cast<double>(std::max(l, levels_) + 1));
  }

  LevelArrays& coefficients() { return result_.solution.coefficients; }

  std::vector<double> even(double length) const {
    return std::vector<double>(samples_.points.size(), length);
  }

  // Of points that do not carry their own scatter, detail between samples looks like strays; and
  // longer fits round off whole features.
  void distrust(const std::vector<double>& residuals, double length) {
    if (samples_.scattered_all_around ||
        length > judged_spacings * std::sqrt(median(samples_.area)))
      return;
    trust_ = trust(samples_, residuals, smoothing_.mean_around(residuals), length);
  }

  void solve(const std::vector<double>& length, double relative_residual) {
    system_.set_weights(smoothing_weights(samples_, length, trust_));
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
  std::vector<double> trust_;
  LocalSmoothing smoothing_;
  SsdSystem<Real> system_;
  SsdSolver<Real> solver_;
  SsdFit result_;
};

template <class Real>
SsdFit fitted(const OctreeGrid& grid, const Samples& samples, const SsdFitOptions& options,
              const Progress& progress) {
  Fit<Real> fit(grid, samples, options);
  // Residuals of exact samples are of the cells' making: there shorter is better.
  if (is_exact(samples))
    fit.start(progress);
  else
    fit.search(progress);
  fit.finish();
  if (progress) progress("solve", 1);
  return fit.take();
}

// `far` as samples of no scatter and of no direction; their areas are those of their cells' sides.
Samples with_far_places(Samples samples, const FarPlaces& far) {
  for (const Eigen::Vector3d& place : far.places) {
    samples.points.push_back(place);
    samples.normals.push_back(Eigen::Vector3d::Zero());
    samples.area.push_back(far_distance * far_distance);
    samples.sigma.push_back(0);
  }
  return samples;
}

template <class Real>
void solve_again(const OctreeGrid& grid, const Samples& samples, const FarPlaces& far,
                 const SsdFitOptions& options, SsdFit& fit) {
  SampleWeights weights = smoothing_weights(samples, fit.length, fit.trust);
  for (const double distance : far.distances) {
    weights.value.push_back(4 * far_distance * far_distance / std::pow(std::abs(distance), 3));
    weights.gradient.push_back(0);
  }
  const Samples all = with_far_places(samples, far);
  SsdSystem<Real> system(grid, all, weights);
  SsdSolver<Real> solver(system, grid);
  solver.refresh();
  SsdSolution& solution = fit.solution;
  if (samples.scattered_all_around && !is_exact(samples))
    system.aim_at_scattered_mean(solution.coefficients);
  system.aim_at(far.distances, samples.points.size());
  solution.iterations +=
      solver.improve(options.relative_residual, options.max_iterations - solution.iterations,
                     solution.coefficients);
  solution.relative_residual = solver.relative_residual(solution.coefficients);
  solution.stop = solution.relative_residual <= 1.01 * options.relative_residual
                      ? SolveStop::converged
                      : SolveStop::iteration_limit;
}

}  // namespace

SampleWeights smoothing_weights(const Samples& samples, const std::vector<double>& length,
                                const std::vector<double>& trust) {
  SampleWeights weights;
  for (std::size_t i = 0; i < length.size(); ++i) {
    const double area = samples.area[i], sigma = samples.sigma[i];
    const double l = std::max(length[i], least_length(area, sigma));
    weights.value.push_back(trust[i] * 4 * area / (l * l * l));
    weights.gradient.push_back((slope_share * l * l + patch_share * exactness(area, sigma) * area) *
                               weights.value.back());
  }
  return weights;
}

std::vector<double> trust(const Samples& samples, const std::vector<double>& residuals,
                          const std::vector<double>& mean_around, double length) {
  std::vector<double> trust(residuals.size());
  for (std::size_t i = 0; i < trust.size(); ++i) {
    const double tolerance = std::max(
        {tolerated_sigmas * samples.sigma[i], tolerated_spacings * std::sqrt(samples.area[i]),
         tolerated_lengths * length, tolerated_means * mean_around[i]});
    const double share = tolerance / std::max(tolerance, std::abs(residuals[i]));
    trust[i] = share * share * share * share;
  }
  return trust;
}

SsdFitOptions chosen_for(const Samples& samples, SsdFitOptions options) {
  const double area = median(samples.area), sigma = median(samples.sigma);
  if (!(options.length > 0))
    options.length = std::max(least_length(area, sigma), least_sigmas * sigma);
  if (!(options.relative_residual > 0))
    options.relative_residual =
        exactness(area, sigma) > 0 ? residual_of_exact : residual_of_scattered;
  return options;
}

SsdFit fit_surface(const OctreeGrid& grid, const Samples& samples, const SsdFitOptions& options,
                   const Progress& progress) {
  const SsdFitOptions chosen = chosen_for(samples, options);
  return chosen.relative_residual < least_residual_in_floats
             ? fitted<double>(grid, samples, chosen, progress)
             : fitted<float>(grid, samples, chosen, progress);
}

void fit_again(const OctreeGrid& grid, const Samples& samples, const FarPlaces& far,
               const SsdFitOptions& options, SsdFit& fit) {
  const SsdFitOptions chosen = chosen_for(samples, options);
  if (chosen.relative_residual < least_residual_in_floats)
    solve_again<double>(grid, samples, far, chosen, fit);
  else
    solve_again<float>(grid, samples, far, chosen, fit);
}

}  // namespace scan
