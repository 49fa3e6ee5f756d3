// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Single blocks of the inverse of a sparse matrix, for no more work than its factorisation.
#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <utility>
#include <vector>

#include "libscan/core/pose.h"

namespace scan {

// The 6 x 6 blocks along the diagonal of A^-1, A symmetric, positive definite and of 6 n rows: by
// Takahashi's recursion over the pattern of A's factor (Takahashi, Fagan, Chin 1973; Erisman,
// Tinney, CACM 18, 1975), in a time that does not grow with the square of n as n solves would.
std::vector<Matrix6> inverse_blocks(const Eigen::SparseMatrix<double>& a);

// Row and column of a 6 x 6 block, counted in blocks.
using BlockAt = std::pair<std::size_t, std::size_t>;

// Those blocks of A^-1 M A^-1, M symmetric: less the derivative of (A + e M)^-1 by e at 0, the
// recursion carried through with it.
std::vector<Matrix6> sandwich_blocks(const Eigen::SparseMatrix<double>& a,
                                     const Eigen::SparseMatrix<double>& m,
                                     std::span<const BlockAt> places);

}  // namespace scan
