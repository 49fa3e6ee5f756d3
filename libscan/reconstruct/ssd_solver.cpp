// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/block_factors.h"

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

// The coarsest level solved exactly, those below the finest block by block, the finest by its
// diagonal. Where exact solutions matter are smooth functions that vanish at the samples: their
// energy is far below that of the functions they are made of.
class Preconditioner {
 public:
  Preconditioner(const SsdSystem& system, const OctreeGrid& grid)
      : functions_(system.coarsest_functions()), blocks_(system.finest()) {
    CellMatrices term;
    for (std::size_t l = std::max<std::size_t>(system.finest(), 1); l-- > 0;) {
      term = system.sample_matrices(l, term);
      if (l > 0) blocks_[l] = BlockFactors(grid.levels[l], system.bending(l), term);
    }
    coarsest_.compute(system.coarsest_matrix(term));
    if (coarsest_.info() != Eigen::Success)
      throw Error(Trouble::computation, "ssd: the coarsest level's matrix is not positive definite",
                  "the weights differ too much, or the points do not determine a surface");
    if (system.finest() > 0) diagonal_ = system.finest_diagonal();
  }

  void apply(const LevelArrays& residual, std::size_t finest, LevelArrays& z) const {
    Eigen::VectorXd coarse(functions_.size());
    for (std::size_t i = 0; i < functions_.size(); ++i) coarse[i] = residual[0][functions_[i]];
    coarsest_.solveInPlace(coarse);
    for (std::size_t i = 0; i < functions_.size(); ++i) z[0][functions_[i]] = coarse[i];
    for (std::size_t l = 1; l < finest; ++l)
      parallel_for(
          z[l].size() / block_size,
          [&](std::size_t b) {
            blocks_[l].solve(b, residual[l].data() + b * block_size, z[l].data() + b * block_size);
          },
          16);
    if (finest > 0)
      parallel_for(
          z[finest].size(),
          [&](std::size_t i) { z[finest][i] = residual[finest][i] / diagonal_[i]; }, chunk);
  }

  // sqrt(r' P r)
  double norm(const LevelArrays& residual, std::size_t finest, LevelArrays& z) const {
    apply(residual, finest, z);
    return std::sqrt(dot(residual, z, finest));
  }

 private:
  std::vector<std::uint32_t> functions_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
  std::vector<BlockFactors> blocks_;  // per level below the finest; none for the coarsest
  std::vector<double> diagonal_;      // of the finest
};

struct Work {
  LevelArrays residual, preconditioned, direction, product;
};

}  // namespace

struct SsdSolver::State {
  SsdSystem& system;
  const OctreeGrid& grid;
  std::optional<Preconditioner> precondition;
  Work work;

  // work.residual = b - A x
  void start_residual(const LevelArrays& b, const LevelArrays& x) {
    system.multiply(x, work.product);
    work.residual = b;
    add_scaled(work.residual, -1, work.product, system.finest());
  }
};

SsdSolver::SsdSolver(SsdSystem& system, const OctreeGrid& grid)
    : state_(new State{
          system,
          grid,
          std::nullopt,
          {active_arrays(grid), active_arrays(grid), active_arrays(grid), active_arrays(grid)}}) {}

SsdSolver::~SsdSolver() = default;

void SsdSolver::refresh() {
  state_->precondition.reset();
  state_->precondition.emplace(state_->system, state_->grid);
}

int SsdSolver::improve(double relative_residual, int max_iterations, LevelArrays& x) {
  SsdSystem& system = state_->system;
  const Preconditioner& precondition = *state_->precondition;
  Work& work = state_->work;
  const std::size_t finest = system.finest();
  const LevelArrays b = system.right_side();
  const double target = relative_residual * precondition.norm(b, finest, work.preconditioned);
  state_->start_residual(b, x);
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

double SsdSolver::relative_residual(const LevelArrays& x) {
  const LevelArrays b = state_->system.right_side();
  const std::size_t finest = state_->system.finest();
  LevelArrays& z = state_->work.preconditioned;
  const double scale = state_->precondition->norm(b, finest, z);
  state_->start_residual(b, x);
  const double left = state_->precondition->norm(state_->work.residual, finest, z);
  return scale > 0 ? left / scale : 0;
}

SsdSolution solve(SsdSystem& system, const OctreeGrid& grid, double relative_residual,
                  int max_iterations) {
  SsdSolution solution;
  solution.coefficients = active_arrays(grid);
  SsdSolver solver(system, grid);
  const std::size_t levels = grid.levels.size();
  for (std::size_t l = 0; l < levels; ++l) {
    system.use_levels(l);
    solver.refresh();
    // What a coarse start leaves behind the finer levels must repair anyway: ten times the target.
    const double share = l + 1 < levels ? 10 * relative_residual : relative_residual;
    solution.iterations +=
        solver.improve(share, max_iterations - solution.iterations, solution.coefficients);
  }
  solution.relative_residual = solver.relative_residual(solution.coefficients);
  // The residual that conjugate gradients carries along drifts from the true one by rounding.
  if (solution.relative_residual <= 1.01 * relative_residual) solution.stop = SolveStop::converged;
  return solution;
}

}  // namespace scan
