// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Minimiser of the SSD energy: conjugate gradients, from the coarsest level to all levels.
#pragma once

#include "libscan/core/progress.h"
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

// Preconditioner: the diagonal of the system with all levels' functions, which acts as a multilevel
// preconditioner of the finest level (Bramble, Pasciak and Xu 1990; Griebel 1994), and an exact
// solution on the coarsest level.
SsdSolution solve(SsdSystem& system, const OctreeGrid& grid, double relative_residual,
                  int max_iterations, const Progress& progress = {});

}  // namespace scan
