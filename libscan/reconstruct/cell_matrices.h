// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The samples' term of one level as small matrices, one for each cell that holds samples.
#pragma once

#include <Eigen/Core>

#include "libscan/reconstruct/cell_samples.h"
#include "libscan/reconstruct/sample_term.h"

namespace scan {

// The matrix of a cell's 27 functions. Each entry is a product over the axes, and along an axis
// three functions form six pairs; so it has 6^3 different entries, pairs along x fastest.
inline constexpr int axis_pairs = 6;
inline constexpr int pair_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
using CellMatrix = std::array<double, axis_pairs * axis_pairs * axis_pairs>;

// Of functions i and j of the cell's 27, x fastest.
inline double entry(const CellMatrix& matrix, int i, int j) {
  return matrix[static_cast<std::size_t>(
      pair_of[i % 3][j % 3] +
      axis_pairs * (pair_of[i / 3 % 3][j / 3 % 3] + axis_pairs * pair_of[i / 9][j / 9]))];
}

struct CellMatrices {
  std::vector<std::uint32_t> cells;  // ascending
  std::vector<CellMatrix> matrices;
};

CellMatrices cell_matrices(const BlockLevel& level, const Samples& samples,
                           const SampleWeights& weights, std::span<const CellSample> placed);

// `finer` of level l + 1 in the functions of level l, and what level l has of its own.
CellMatrices coarsened(const OctreeGrid& grid, std::size_t l, const CellMatrices& finer,
                       const CellMatrices& own);

// The term's matrix for all functions of a level whose blocks are all active. `row_of`: row of each
// function, -1: none.
void add_dense(const BlockLevel& level, const CellMatrices& term,
               std::span<const std::int32_t> row_of, Eigen::MatrixXd& matrix);

}  // namespace scan
