// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t chunk = 4096;

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
    parallel_for(
        a[l].size(), [&](std::size_t i) { a[l][i] += factor * b[l][i]; }, chunk);
}

// direction = z + factor * direction
void next_direction(LevelArrays& direction, double factor, const LevelArrays& z,
                    std::size_t finest) {
  for (std::size_t l = 0; l <= finest; ++l)
    parallel_for(
        direction[l].size(),
        [&](std::size_t i) { direction[l][i] = z[l][i] + factor * direction[l][i]; }, chunk);
}

// The coarsest level solved exactly, the others by their diagonal. The exact solution is what
// smooth functions that vanish at the samples need: their energy is far below that of the functions
// they are made of.
class Preconditioner {
 public:
  explicit Preconditioner(const SsdSystem& system)
      : functions_(system.coarsest_functions()),
        matrix_(system.coarsest_matrix()),
        coarsest_(matrix_),
        diagonal_(system.diagonal()) {
    if (coarsest_.info() != Eigen::Success)
      throw Error(Trouble::computation, "ssd: the coarsest level's matrix is not positive definite",
                  "the weights differ too much, or the points do not determine a surface");
  }

  void apply(const LevelArrays& residual, std::size_t finest, LevelArrays& z) const {
    Eigen::VectorXd coarse(functions_.size());
    for (std::size_t i = 0; i < functions_.size(); ++i) coarse[i] = residual[0][functions_[i]];
    coarsest_.solveInPlace(coarse);
    for (std::size_t i = 0; i < functions_.size(); ++i) z[0][functions_[i]] = coarse[i];
    for (std::size_t l = 1; l <= finest; ++l)
      parallel_for(
          z[l].size(), [&](std::size_t i) { z[l][i] = residual[l][i] / diagonal_[l][i]; }, chunk);
  }

  // sqrt(r' P r)
  double norm(const LevelArrays& residual, std::size_t finest, LevelArrays& z) const {
    apply(residual, finest, z);
    return std::sqrt(dot(residual, z, finest));
  }

 private:
  std::vector<std::uint32_t> functions_;
  Eigen::MatrixXd matrix_;  // factorised in place
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> coarsest_;
  LevelArrays diagonal_;
};

struct Work {
  LevelArrays residual, preconditioned, direction, product;
};

// residual = b - A x
void start_residual(SsdSystem& system, const LevelArrays& b, const LevelArrays& x, Work& work) {
  system.multiply(x, work.product);
  work.residual = b;
  add_scaled(work.residual, -1, work.product, system.finest());
}

// Conjugate gradients on the levels in use, from x. Returns the iterations.
int conjugate_gradients(SsdSystem& system, const LevelArrays& b, const Preconditioner& precondition,
                        double target, int max_iterations, LevelArrays& x, Work& work) {
  const std::size_t finest = system.finest();
  start_residual(system, b, x, work);
  for (auto& values : work.direction) std::fill(values.begin(), values.end(), 0.0);
  precondition.apply(work.residual, finest, work.preconditioned);
  double rho = dot(work.residual, work.preconditioned, finest);
  double factor = 0;
  int iteration = 0;
  for (; iteration < max_iterations && rho > target * target; ++iteration) {
    next_direction(work.direction, factor, work.preconditioned, finest);
    system.multiply(work.direction, work.product);
    const double curvature = dot(work.direction, work.product, finest);
    if (!(curvature > 0)) break;  // at the rounding level of a semidefinite system
    add_scaled(x, rho / curvature, work.direction, finest);
    add_scaled(work.residual, -rho / curvature, work.product, finest);
    precondition.apply(work.residual, finest, work.preconditioned);
    const double previous = rho;
    rho = dot(work.residual, work.preconditioned, finest);
    factor = rho / previous;
  }
  return iteration;
}

}  // namespace

SsdSolution solve(SsdSystem& system, const OctreeGrid& grid, double relative_residual,
                  int max_iterations, const Progress& progress) {
  SsdSolution solution;
  solution.coefficients = active_arrays(grid);
  Work work{active_arrays(grid), active_arrays(grid), active_arrays(grid), active_arrays(grid)};
  const std::size_t levels = grid.levels.size();
  system.use_levels(levels - 1);
  const Preconditioner precondition(system);
  double scale = 0;
  for (std::size_t l = 0; l < levels; ++l) {
    if (progress) progress("solve", static_cast<double>(l) / static_cast<double>(levels));
    system.use_levels(l);
    const LevelArrays b = system.right_side();
    // What a coarse start leaves behind the finer levels must repair anyway: ten times the target.
    const double share = l + 1 < levels ? 10 * relative_residual : relative_residual;
    scale = precondition.norm(b, l, work.preconditioned);
    solution.iterations +=
        conjugate_gradients(system, b, precondition, share * scale,
                            max_iterations - solution.iterations, solution.coefficients, work);
    if (l + 1 == levels) start_residual(system, b, solution.coefficients, work);
  }
  const double left = precondition.norm(work.residual, levels - 1, work.preconditioned);
  solution.relative_residual = scale > 0 ? left / scale : 0;
  // The residual that conjugate gradients carries along drifts from the true one by rounding.
  if (solution.relative_residual <= 1.01 * relative_residual) solution.stop = SolveStop::converged;
  if (progress) progress("solve", 1);
  return solution;
}

}  // namespace scan
