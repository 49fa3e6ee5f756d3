// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Small Cholesky factors in floats, half of the square, for preconditioners.
#pragma once

#include <Eigen/Cholesky>
#include <array>

#include "libscan/core/error.h"

namespace scan {

// Rows of the factor's lower half, one after the other; inverses on the diagonal. Rounding its
// entries leaves L L' symmetric and positive definite.
template <int size>
using PackedCholesky = std::array<float, size*(size + 1) / 2>;

// Of the matrix's lower half, which is lost. Throws scan::Error (computation) if it is not positive
// definite.
template <int size>
PackedCholesky<size> packed_cholesky(Eigen::Matrix<double, size, size>& matrix) {
  const Eigen::LLT<Eigen::Ref<Eigen::Matrix<double, size, size>>> factor(matrix);
  if (factor.info() != Eigen::Success)
    throw Error(Trouble::computation, "ssd: the matrix of a block is not positive definite",
                "the weights differ too much");
  PackedCholesky<size> rows;
  float* to = rows.data();
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) *to++ = static_cast<float>(matrix(i, j));
    *to++ = static_cast<float>(1 / matrix(i, i));
  }
  return rows;
}

// x = (L L')^-1 x
template <int size>
void solve_packed(const PackedCholesky<size>& rows, Eigen::Matrix<float, size, 1>& x) {
  using Row = Eigen::Map<const Eigen::VectorXf>;
  const float* row = rows.data();
  for (Eigen::Index i = 0; i < size; row += ++i)
    x[i] = (x[i] - Row(row, i).dot(x.head(i))) * row[i];
  for (Eigen::Index i = size; i-- > 0;) {
    row -= i + 1;
    x[i] *= row[i];
    x.head(i) -= x[i] * Row(row, i);
  }
}

}  // namespace scan
