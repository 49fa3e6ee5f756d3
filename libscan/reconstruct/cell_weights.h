// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The 27 functions of a cell at a point in it: sums over a cube of block_cell_functions a side.
#pragma once

#include "libscan/reconstruct/spline_levels.h"

namespace scan {

inline constexpr int cube_width = block_cell_functions;

inline constexpr int cube_size = cube_width * cube_width * cube_width;

inline BlockPlace cell_at(const Eigen::Vector3d& u, int cells) {
  return {cell_of(u[0], cells), cell_of(u[1], cells), cell_of(u[2], cells)};
}

// Of a cell's functions in its block's cube.
inline int cube_corner(const BlockPlace& cell) {
  return cell[0] % 4 + cube_width * (cell[1] % 4 + cube_width * (cell[2] % 4));
}

struct CellWeights {
  SplineWeights x, y, z;
};

inline CellWeights weights_at(const Eigen::Vector3d& in_cell) {
  return {spline_weights(in_cell[0]), spline_weights(in_cell[1]), spline_weights(in_cell[2])};
}

struct ValueAndSlope {
  double value = 0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  // per cell width
};

inline ValueAndSlope evaluate(const double* cube, const CellWeights& w) {
  ValueAndSlope f;
  for (int c = 0; c < 3; ++c)
    for (int b = 0; b < 3; ++b) {
      const int first = cube_width * (b + cube_width * c);
      const double* q = cube + first;
      const double value = w.x.value[0] * q[0] + w.x.value[1] * q[1] + w.x.value[2] * q[2];
      const double slope = w.x.slope[0] * q[0] + w.x.slope[1] * q[1] + w.x.slope[2] * q[2];
      f.value += w.y.value[b] * w.z.value[c] * value;
      f.slope[0] += w.y.value[b] * w.z.value[c] * slope;
      f.slope[1] += w.y.slope[b] * w.z.value[c] * value;
      f.slope[2] += w.y.value[b] * w.z.slope[c] * value;
    }
  return f;
}

// Of the second derivatives, per square of the cell's width.
inline double laplacian(const double* cube, const CellWeights& w) {
  constexpr std::array<double, 3> second = {1, -2, 1};
  double sum = 0;
  for (int i = 0; i < 27; ++i) {
    const int a = i % 3, b = i / 3 % 3, c = i / 9;
    sum += cube[a + cube_width * (b + cube_width * c)] *
           (second[a] * w.y.value[b] * w.z.value[c] + w.x.value[a] * second[b] * w.z.value[c] +
            w.x.value[a] * w.y.value[b] * second[c]);
  }
  return sum;
}

// Adds value * B + slope . grad B of the cell's 27 functions B (the transpose of evaluate).
inline void accumulate(double* cube, const CellWeights& w, const ValueAndSlope& f) {
  for (int c = 0; c < 3; ++c)
    for (int b = 0; b < 3; ++b) {
      const int first = cube_width * (b + cube_width * c);
      double* q = cube + first;
      const double by_value = f.value * w.y.value[b] * w.z.value[c] +
                              f.slope[1] * w.y.slope[b] * w.z.value[c] +
                              f.slope[2] * w.y.value[b] * w.z.slope[c];
      const double by_slope = f.slope[0] * w.y.value[b] * w.z.value[c];
      for (int a = 0; a < 3; ++a) q[a] += by_value * w.x.value[a] + by_slope * w.x.slope[a];
    }
}

}  // namespace scan
