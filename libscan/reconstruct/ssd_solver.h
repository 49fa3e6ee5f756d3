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
  // Of the whole system: sqrt(r' D^-1 r / b' D^-1 b), r = b - A x computed anew at the end, D the
  // diagonal; so it does not depend on the scale of a level's functions.
  double relative_residual = 0;
  SolveStop stop = SolveStop::iteration_limit;
};

// The diagonal as preconditioner of a system with all levels' functions is a multilevel
// preconditioner of the finest level's (Bramble, Pasciak and Xu 1990; Griebel 1994).
SsdSolution solve(SsdSystem& system, const OctreeGrid& grid, double relative_residual,
                  int max_iterations, const Progress& progress = {});

}  // namespace scan
