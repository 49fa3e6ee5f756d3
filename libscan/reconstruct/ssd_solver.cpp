// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_solver.h"

#include <cmath>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t chunk = 4096;

double weighted_dot(const LevelArrays& a, const LevelArrays& b, const LevelArrays& divisor,
                    std::size_t finest) {
  double total = 0;
  for (std::size_t l = 0; l <= finest; ++l)
    total += ordered_sum(a[l].size(), chunk, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += a[l][i] * b[l][i] / divisor[l][i];
      return sum;
    });
  return total;
}

double dot(const LevelArrays& a, const LevelArrays& b, std::size_t finest) {
  double total = 0;
  for (std::size_t l = 0; l <= finest; ++l)
    total += ordered_sum(a[l].size(), chunk, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += a[l][i] * b[l][i];
      return sum;
    });
  return total;
}

// a += factor * b
void add_scaled(LevelArrays& a, double factor, const LevelArrays& b, std::size_t finest) {
  for (std::size_t l = 0; l <= finest; ++l)
    parallel_for(a[l].size(), [&](std::size_t i) { a[l][i] += factor * b[l][i]; }, chunk);
}

// direction = residual / diagonal + factor * direction
void next_direction(LevelArrays& direction, double factor, const LevelArrays& residual,
                    const LevelArrays& diagonal, std::size_t finest) {
  for (std::size_t l = 0; l <= finest; ++l)
    parallel_for(
        direction[l].size(),
        [&](std::size_t i) {
          direction[l][i] = residual[l][i] / diagonal[l][i] + factor * direction[l][i];
        },
        chunk);
}

struct Work {
  LevelArrays residual, direction, product;
};

// residual = b - A x
void start_residual(SsdSystem& system, const LevelArrays& b, const LevelArrays& x, Work& work) {
  system.multiply(x, work.product);
  work.residual = b;
  add_scaled(work.residual, -1, work.product, system.finest());
}

// Conjugate gradients on the levels in use, from x. Returns the iterations.
int conjugate_gradients(SsdSystem& system, const LevelArrays& b, const LevelArrays& diagonal,
                        double target, int max_iterations, LevelArrays& x, Work& work) {
  const std::size_t finest = system.finest();
  start_residual(system, b, x, work);
  double rho = weighted_dot(work.residual, work.residual, diagonal, finest);
  double factor = 0;
  int iteration = 0;
  for (; iteration < max_iterations && rho > target * target; ++iteration) {
    next_direction(work.direction, factor, work.residual, diagonal, finest);
    system.multiply(work.direction, work.product);
    const double curvature = dot(work.direction, work.product, finest);
    if (!(curvature > 0)) break;  // at the rounding level of a semidefinite system
    add_scaled(x, rho / curvature, work.direction, finest);
    add_scaled(work.residual, -rho / curvature, work.product, finest);
    const double previous = rho;
    rho = weighted_dot(work.residual, work.residual, diagonal, finest);
    factor = rho / previous;
  }
  return iteration;
}

}  // namespace

SsdSolution solve(SsdSystem& system, const OctreeGrid& grid, double relative_residual,
                  int max_iterations, const Progress& progress) {
  SsdSolution solution;
  solution.coefficients = active_arrays(grid);
  Work work{active_arrays(grid), active_arrays(grid), active_arrays(grid)};
  const std::size_t levels = grid.levels.size();
  system.use_levels(levels - 1);
  const LevelArrays diagonal = system.diagonal();
  const double whole = std::sqrt(weighted_dot(system.right_side(), system.right_side(), diagonal,
                                              levels - 1));
  for (std::size_t l = 0; l < levels; ++l) {
    if (progress) progress("solve", static_cast<double>(l) / static_cast<double>(levels));
    system.use_levels(l);
    const LevelArrays b = system.right_side();
    // What a coarse start leaves behind the finer levels must repair anyway: ten times the target.
    const double share = l + 1 < levels ? 10 * relative_residual : relative_residual;
    const double scale = std::sqrt(weighted_dot(b, b, diagonal, l));
    for (auto& values : work.direction) std::fill(values.begin(), values.end(), 0.0);
    solution.iterations +=
        conjugate_gradients(system, b, diagonal, share * scale,
                            max_iterations - solution.iterations, solution.coefficients, work);
    if (l + 1 == levels) start_residual(system, b, solution.coefficients, work);
  }
  const double left = std::sqrt(weighted_dot(work.residual, work.residual, diagonal, levels - 1));
  solution.relative_residual = whole > 0 ? left / whole : 0;
  // The residual that conjugate gradients carries along drifts from the true one by rounding.
  if (solution.relative_residual <= 1.01 * relative_residual) solution.stop = SolveStop::converged;
  if (progress) progress("solve", 1);
  return solution;
}

}  // namespace scan
