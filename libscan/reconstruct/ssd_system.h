// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The energy of SSD on the levels of an octree: matrix, right side, diagonal.
#pragma once

#include <vector>

#include "libscan/reconstruct/cell_matrices.h"

namespace scan {

// E(x) = sum_i (v_i f(p_i)^2 + g_i |grad f(p_i) - n_i|^2) + integral |D^2 f|^2 (Calakli and Taubin
// 2011, eq. 3-5), f = sum of all levels' splines up to a finest one. Half its gradient is A x - b.
// A is semidefinite: levels repeat each other's functions.
class SsdSystem {
 public:
  // Keeps references: grid and samples must live as long.
  SsdSystem(const OctreeGrid& grid, const Samples& samples, SampleWeights weights);
  void set_weights(SampleWeights weights);

  // From now on only levels 0 ... `finest` act; deeper samples are seen by that level.
  void use_levels(std::size_t finest);
  std::size_t finest() const { return finest_; }

  // y = A x; arrays of active blocks, as from active_arrays().
  void multiply(const LevelArrays& x, LevelArrays& y) { multiply(x, y, true); }
  LevelArrays right_side();
  // Of A, on the finest level in use; 1 where a row is empty (functions outside the cube).
  std::vector<double> finest_diagonal() const;
  // The term of all samples that level l's functions meet; l is below the finest level, or 0.
  // `finer`: that of level l + 1, if l + 1 is below the finest.
  CellMatrices sample_matrices(std::size_t l, const CellMatrices& finer) const;
  const BendingStencil& bending(std::size_t l) const { return bending_[l]; }
  // The coarsest level's functions that lie in the cube, and the block of A for these, dense.
  std::vector<std::uint32_t> coarsest_functions() const;
  Eigen::MatrixXd coarsest_matrix(const CellMatrices& samples) const;
  // Per sample: f / |grad f|, to first order the distance to the zero set.
  std::vector<double> residuals(const LevelArrays& x);
  // From now on aims at f = sigma^2 / 2 times the Laplacian of x at each sample, not at f = 0: that
  // is what samples of the surface, scattered by sigma in all directions, find there on average.
  void aim_at_scattered_mean(const LevelArrays& x);
  double energy(const LevelArrays& x);

 private:
  void multiply(const LevelArrays& x, LevelArrays& y, bool with_samples);
  void accumulate_coarse_to_fine(const LevelArrays& x);

  const OctreeGrid& grid_;
  const Samples& samples_;
  std::vector<int> depths_;
  // Of each level below the finest; the last holds the finest level's samples too.
  std::vector<std::vector<CellSample>> in_cells_;
  SampleWeights weights_;
  std::size_t finest_ = 0;
  std::vector<BendingStencil> bending_;
  std::vector<SampleTerm> terms_;
  LevelArrays sums_;       // of x and all coarser levels, in each level's own functions
  LevelArrays residuals_;  // what the finer levels and the samples put on a level
};

}  // namespace scan
