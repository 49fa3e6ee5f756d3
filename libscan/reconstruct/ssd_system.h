// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The energy of SSD on the levels of an octree: matrix, right side, diagonal.
#pragma once

#include <vector>

#include "libscan/reconstruct/cell_matrices.h"
#include "libscan/reconstruct/octet_factors.h"

namespace scan {

// E(x) = sum_i (v_i f(p_i)^2 + g_i |grad f(p_i) - n_i|^2) + integral |D^2 f|^2 (Calakli and Taubin
// 2011, eq. 3-5), f = sum of all levels' splines up to a finest one. Half its gradient is A x - b.
// A is semidefinite: levels repeat each other's functions. Arrays and sums over functions are of
// type Real, float or double.
template <class Real>
class SsdSystem {
 public:
  using Arrays = LevelArraysOf<Real>;
  // Keeps references: grid and samples must live as long. All levels act.
  SsdSystem(const OctreeGrid& grid, const Samples& samples, SampleWeights weights);
  void set_weights(SampleWeights weights);

  // From now on only levels 0 ... `finest` act; deeper samples are seen by that level.
  void use_levels(std::size_t finest);
  std::size_t finest() const { return finest_; }

  // y = A x; arrays of active blocks, as from active_arrays().
  void multiply(const Arrays& x, Arrays& y) { multiply(x, y, true); }
  void right_side(Arrays& b);
  // Of A, on the finest level in use; 1 where a row is empty (functions outside the cube).
  std::vector<Real> finest_diagonal();
  // Of the level below the finest, which is not the coarsest.
  OctetFactors octet_factors() const;
  // The number of levels below these two, at least 1.
  std::size_t levels_of_blocks() const { return finest_ < 2 ? 1 : finest_ - 1; }
  // The term of all samples that level l's functions meet, for these levels. `finer`: that of level
  // l + 1, if it is one of them.
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
  // From now on aims at f = targets[k] at sample `first` + k.
  void aim_at(std::span<const double> targets, std::size_t first);
  double energy(const Arrays& x);

 private:
  void multiply(const Arrays& x, Arrays& y, bool with_samples);
  template <class Coefficients>
  void accumulate_coarse_to_fine(const Coefficients& x);

  const OctreeGrid& grid_;
  const Samples& samples_;
  std::vector<int> depths_;
  // Of the levels of blocks, the last with all finer ones' samples; and of that of octets likewise.
  std::vector<std::vector<CellSample>> in_cells_;
  std::vector<CellSample> in_octet_cells_;
  SampleWeights weights_;
  std::size_t finest_ = 0;
  std::vector<BendingStencil> bending_;
  std::vector<SampleTerm<Real>> terms_;
  Arrays sums_;       // of x and all coarser levels, in each level's own functions
  Arrays residuals_;  // what the finer levels and the samples put on a level
};

}  // namespace scan
