// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Minimiser of the SSD energy: conjugate gradients, from the coarsest level to all levels.
#pragma once

#include <memory>

#include "libscan/reconstruct/ssd_system.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

struct SsdSolution {
  LevelArrays coefficients;
  int iterations = 0;  // on all levels together
  // Of the whole system: sqrt(r' P r / b' P b), r = b - A x computed anew at the end, P the
  // preconditioner; so it is near the energy norm of the error over that of the solution.
  double relative_residual = 0;
  SolveStop stop = SolveStop::iteration_limit;
};

// Preconditioner: additive over the levels (Bramble, Pasciak and Xu 1990; Griebel 1994), by the
// diagonal on the finest, by octets on the next, block by block on those below, exact on the
// coarsest. All arrays but the solution are of type Real, float or double; sums over all of them
// are in double either way.
template <class Real>
class SsdSolver {
 public:
  // Keeps references to system and grid.
  SsdSolver(SsdSystem<Real>& system, const OctreeGrid& grid);
  ~SsdSolver();
  // To be called first, and when the system's levels or weights have changed.
  void refresh();
  // Conjugate gradients on the levels in use until the residual is `relative_residual` of the right
  // side. Returns the iterations.
  int improve(double relative_residual, int max_iterations, LevelArrays& x);
  // sqrt(r' P r / b' P b), r = b - A x.
  double relative_residual(const LevelArrays& x);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// From the coarsest level to all levels.
template <class Real>
SsdSolution solve(SsdSystem<Real>& system, const OctreeGrid& grid, double relative_residual,
                  int max_iterations);

}  // namespace scan
