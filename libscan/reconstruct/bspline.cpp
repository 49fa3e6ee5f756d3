// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/bspline.h"

#include <algorithm>

namespace scan {
namespace {

using CellMatrix = std::array<std::array<double, 3>, 3>;

// Integrals over one cell of products of (1-t)^2/2, 1/2+t-t^2 and t^2/2 and of their derivatives.
constexpr CellMatrix cell_mass = {{{6. / 120, 13. / 120, 1. / 120},
                                   {13. / 120, 54. / 120, 13. / 120},
                                   {1. / 120, 13. / 120, 6. / 120}}};
constexpr CellMatrix cell_stiffness = {
    {{1. / 3, -1. / 6, -1. / 6}, {-1. / 6, 1. / 3, -1. / 6}, {-1. / 6, -1. / 6, 1. / 3}}};
constexpr CellMatrix cell_bending = {{{1, -2, 1}, {-2, 4, -2}, {1, -2, 1}}};

double integral(const CellMatrix& cell_matrix, int i, int j, int cells) {
  double sum = 0;
  const int last = std::min({i, j, cells - 1});
  for (int cell = std::max({i - 2, j - 2, 0}); cell <= last; ++cell)
    sum += cell_matrix[i - cell][j - cell];
  return sum;
}

}  // namespace

std::vector<StencilRow> stencil_rows(int cells, int padded_to) {
  const int functions = cells + 2;
  const int padded = (functions + padded_to - 1) / padded_to * padded_to;
  std::vector<StencilRow> rows(padded);
  for (int i = 0; i < functions; ++i)
    for (int tap = 0; tap < 5; ++tap) {
      const int j = i + tap - 2;
      if (j < 0 || j >= functions) continue;
      rows[i].mass[tap] = integral(cell_mass, i, j, cells);
      rows[i].stiffness[tap] = integral(cell_stiffness, i, j, cells);
      rows[i].bending[tap] = integral(cell_bending, i, j, cells);
    }
  return rows;
}

}  // namespace scan
