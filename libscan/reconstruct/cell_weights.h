// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The 27 functions of a cell at a point in it: sums over a cube of block_cell_functions a side.
#pragma once

#include <cstring>

#include "libscan/reconstruct/spline_levels.h"

namespace scan {

inline constexpr int cube_width = block_cell_functions;
inline constexpr int cube_size = cube_width * cube_width * cube_width;
// A row of a cell's functions is loaded with one that follows, of which nothing becomes.
inline constexpr int row_lanes = 4, cube_room = cube_size + 1;

inline BlockPlace cell_at(const Eigen::Vector3d& u, int cells) {
  return {cell_of(u[0], cells), cell_of(u[1], cells), cell_of(u[2], cells)};
}

// Of a cell's functions in its block's cube.
inline int cube_corner(const BlockPlace& cell) {
  return cell[0] % 4 + cube_width * (cell[1] % 4 + cube_width * (cell[2] % 4));
}

template <class Real>
struct CellWeights {
  SplineWeights<Real> x, y, z;
};

template <class Real>
CellWeights<Real> weights_at(const Eigen::Matrix<Real, 3, 1>& in_cell) {
  return {spline_weights(in_cell[0]), spline_weights(in_cell[1]), spline_weights(in_cell[2])};
}

template <class Real>
struct ValueAndSlope {
  Real value = 0;
  Eigen::Matrix<Real, 3, 1> slope = Eigen::Matrix<Real, 3, 1>::Zero();  // per cell width
};

template <class Real>
struct RowVector {
  using Type __attribute__((vector_size(row_lanes * sizeof(Real)))) = Real;
};

template <class Real>
ValueAndSlope<Real> evaluate(const Real* cube, const CellWeights<Real>& w) {
  typename RowVector<Real>::Type row, value = {}, along_y = {}, along_z = {};
  for (int c = 0; c < 3; ++c)
    for (int b = 0; b < 3; ++b) {
      std::memcpy(&row, cube + cube_width * (b + cube_width * c), sizeof row);
      value += (w.y.value[b] * w.z.value[c]) * row;
      along_y += (w.y.slope[b] * w.z.value[c]) * row;
      along_z += (w.y.value[b] * w.z.slope[c]) * row;
    }
  ValueAndSlope<Real> f;
  for (int a = 0; a < 3; ++a) {
    f.value += w.x.value[a] * value[a];
    f.slope[0] += w.x.slope[a] * value[a];
    f.slope[1] += w.x.value[a] * along_y[a];
    f.slope[2] += w.x.value[a] * along_z[a];
  }
  return f;
}

// Of the second derivatives, per square of the cell's width.
template <class Real>
Real laplacian(const Real* cube, const CellWeights<Real>& w) {
  constexpr std::array<Real, 3> second = {1, -2, 1};
  Real sum = 0;
  for (int i = 0; i < 27; ++i) {
    const int a = i % 3, b = i / 3 % 3, c = i / 9;
    sum += cube[a + cube_width * (b + cube_width * c)] *
           (second[a] * w.y.value[b] * w.z.value[c] + w.x.value[a] * second[b] * w.z.value[c] +
            w.x.value[a] * w.y.value[b] * second[c]);
  }
  return sum;
}

// Adds value * B + slope . grad B of the cell's 27 functions B (the transpose of evaluate).
template <class Real>
void accumulate(Real* cube, const CellWeights<Real>& w, const ValueAndSlope<Real>& f) {
  using Row = typename RowVector<Real>::Type;
  const Row values = {w.x.value[0], w.x.value[1], w.x.value[2], 0};
  const Row slopes = {w.x.slope[0], w.x.slope[1], w.x.slope[2], 0};
  for (int c = 0; c < 3; ++c)
    for (int b = 0; b < 3; ++b) {
      Real* q = cube + cube_width * (b + cube_width * c);
      const Real by_value = f.value * w.y.value[b] * w.z.value[c] +
                            f.slope[1] * w.y.slope[b] * w.z.value[c] +
                            f.slope[2] * w.y.value[b] * w.z.slope[c];
      const Real by_slope = f.slope[0] * w.y.value[b] * w.z.value[c];
      Row row;
      std::memcpy(&row, q, sizeof row);
      row += by_value * values + by_slope * slopes;
      std::memcpy(q, &row, sizeof row);
    }
}

}  // namespace scan
