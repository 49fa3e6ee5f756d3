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

template <class Real>
double dot(const LevelArraysOf<Real>& a, const LevelArraysOf<Real>& b, std::size_t finest) {
  double total = 0;
  for (std::size_t l = 0; l <= finest; ++l)
    total += ordered_sum(a[l].size(), chunk, 0.0, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i)
        sum += static_cast<double>(a[l][i]) * static_cast<double>(b[l][i]);
      return sum;
    });
  return total;
}

// Calls body(a's entry, b's entry) for all of these levels.
template <class A, class B, class Body>
void for_entries(A& a, const B& b, std::size_t finest, Body&& body) {
  for (std::size_t l = 0; l <= finest; ++l)
    parallel_for(
        a[l].size(), [&](std::size_t i) { body(a[l][i], b[l][i]); }, chunk);
}

// The coarsest level solved exactly, those well below the finest block by block, the next by its
// octets, the finest by its diagonal. Where exact solutions matter are smooth functions that vanish
// at the samples: their energy is far below that of the functions they are made of. On fine levels
// there is hardly any: whole blocks in place of octets save one iteration in fifteen.
template <class Real>
class Preconditioner {
 public:
  using Arrays = LevelArraysOf<Real>;

  Preconditioner(SsdSystem<Real>& system, const OctreeGrid& grid)
      : functions_(system.coarsest_functions()), blocks_(system.levels_of_blocks()) {
    // The coarsest level's factor is made by one thread: others work on fine levels meanwhile.
    parallel_for(
        2, [&](std::size_t task) { task == 0 ? make_coarse(system, grid) : make_fine(system); }, 1);
  }

  void apply(const Arrays& residual, std::size_t finest, Arrays& z) const {
    Eigen::VectorXd coarse(functions_.size());
    for (std::size_t i = 0; i < functions_.size(); ++i) coarse[i] = residual[0][functions_[i]];
    coarsest_.solveInPlace(coarse);
    for (std::size_t i = 0; i < functions_.size(); ++i)
      z[0][functions_[i]] = static_cast<Real>(coarse[i]);
    for (std::size_t l = 1; l < finest; ++l)
      parallel_for(
          z[l].size() / block_size,
          [&](std::size_t b) {
            const Real* r = residual[l].data() + b * block_size;
            Real* to = z[l].data() + b * block_size;
            l < blocks_.size() ? blocks_[l].solve(b, r, to) : octets_.solve(b, r, to);
          },
          16);
    if (finest > 0)
      parallel_for(
          z[finest].size(),
          [&](std::size_t i) { z[finest][i] = residual[finest][i] / diagonal_[i]; }, chunk);
  }

  // sqrt(r' P r)
  double norm(const Arrays& residual, std::size_t finest, Arrays& z) const {
    apply(residual, finest, z);
    return std::sqrt(dot(residual, z, finest));
  }

 private:
  void make_coarse(const SsdSystem<Real>& system, const OctreeGrid& grid) {
    CellMatrices term;
    for (std::size_t l = blocks_.size(); l-- > 0;) {
      term = system.sample_matrices(l, term);
      if (l > 0) blocks_[l] = BlockFactors(grid.levels[l], system.bending(l), term);
    }
    coarsest_.compute(system.coarsest_matrix(term));
    if (coarsest_.info() != Eigen::Success)
      throw Error(Trouble::computation, "ssd: the coarsest level's matrix is not positive definite",
                  "the weights differ too much, or the points do not determine a surface");
  }

  void make_fine(SsdSystem<Real>& system) {
    if (system.finest() > 0) diagonal_ = system.finest_diagonal();
    if (system.finest() > 1) octets_ = system.octet_factors();
  }

  std::vector<std::uint32_t> functions_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
  std::vector<BlockFactors> blocks_;  // per level; none for the coarsest
  OctetFactors octets_;               // of the level below the finest
  std::vector<Real> diagonal_;        // of the finest
};

}  // namespace

template <class Real>
struct SsdSolver<Real>::State {
  using Arrays = LevelArraysOf<Real>;
  SsdSystem<Real>& system;
  const OctreeGrid& grid;
  std::optional<Preconditioner<Real>> precondition;
  Arrays residual, direction;
  Arrays image;  // of the direction by A, or of the residual by the preconditioner

  // residual = b - A x; direction and image are lost. Returns sqrt(b' P b).
  double start(const LevelArrays& x) {
    const std::size_t finest = system.finest();
    system.right_side(residual);
    const double scale = precondition->norm(residual, finest, image);
    for_entries(direction, x, finest, [](Real& to, double from) { to = static_cast<Real>(from); });
    system.multiply(direction, image);
    for_entries(residual, image, finest, [](Real& r, Real ax) { r -= ax; });
    return scale;
  }
};

template <class Real>
SsdSolver<Real>::SsdSolver(SsdSystem<Real>& system, const OctreeGrid& grid)
    : state_(new State{system, grid, std::nullopt, active_arrays<Real>(grid),
                       active_arrays<Real>(grid), active_arrays<Real>(grid)}) {}

template <class Real>
SsdSolver<Real>::~SsdSolver() = default;

template <class Real>
void SsdSolver<Real>::refresh() {
  state_->precondition.reset();
  state_->precondition.emplace(state_->system, state_->grid);
}

template <class Real>
int SsdSolver<Real>::improve(double relative_residual, int max_iterations, LevelArrays& x) {
  auto& [system, grid, precondition, residual, direction, image] = *state_;
  const std::size_t finest = system.finest();
  const double target = relative_residual * state_->start(x);
  precondition->apply(residual, finest, image);
  double rho = dot(residual, image, finest);
  double factor = 0;
  int iteration = 0;
  for (; iteration < max_iterations && rho > target * target; ++iteration) {
    for_entries(direction, image, finest,
                [by = static_cast<Real>(factor)](Real& d, Real z) { d = z + by * d; });
    system.multiply(direction, image);
    const double curvature = dot(direction, image, finest);
    if (!(curvature > 0)) break;  // at the rounding level of a semidefinite system
    const double step = rho / curvature;
    for_entries(x, direction, finest, [step](double& to, Real d) { to += step * d; });
    for_entries(residual, image, finest,
                [by = static_cast<Real>(step)](Real& r, Real ad) { r -= by * ad; });
    precondition->apply(residual, finest, image);
    const double previous = rho;
    rho = dot(residual, image, finest);
    factor = rho / previous;
  }
  return iteration;
}

template <class Real>
double SsdSolver<Real>::relative_residual(const LevelArrays& x) {
  const double scale = state_->start(x);
  const double left =
      state_->precondition->norm(state_->residual, state_->system.finest(), state_->image);
  return scale > 0 ? left / scale : 0;
}

template <class Real>
SsdSolution solve(SsdSystem<Real>& system, const OctreeGrid& grid, double relative_residual,
                  int max_iterations) {
  SsdSolution solution;
  solution.coefficients = active_arrays(grid);
  SsdSolver<Real> solver(system, grid);
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
  // The residual that conjugate gradients carry along drifts from the true one by rounding.
  if (solution.relative_residual <= 1.01 * relative_residual) solution.stop = SolveStop::converged;
  return solution;
}

template class SsdSolver<float>;
template class SsdSolver<double>;
template SsdSolution solve(SsdSystem<float>&, const OctreeGrid&, double, int);
template SsdSolution solve(SsdSystem<double>&, const OctreeGrid&, double, int);

}  // namespace scan
