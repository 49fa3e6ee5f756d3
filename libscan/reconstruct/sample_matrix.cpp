// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/sample_matrix.h"

#include "libscan/reconstruct/cell_weights.h"

namespace scan {
namespace {

constexpr BlockPlace nowhere = {-1, -1, -1};

BlockPlace block_of(const BlockPlace& cell) {
  return {cell[0] / block_width, cell[1] / block_width, cell[2] / block_width};
}

CellWeights weights_in(const BlockPlace& cell, const Eigen::Vector3d& u, double cells) {
  return weights_at(u * cells - Eigen::Vector3d(cell[0], cell[1], cell[2]));
}

// Where a function of a block's cube lies among all functions of the level.
std::size_t place_in_level(const BlockLevel& level, std::int32_t block, int x, int y, int z) {
  const std::int32_t owner = level.neighbours[static_cast<std::size_t>(block)][neighbour_slot(
      x / block_width, y / block_width, z / block_width)];
  return static_cast<std::size_t>(owner) * block_size +
         static_cast<std::size_t>(slot_in_block(x % block_width, y % block_width, z % block_width));
}

SplineWeights squares(const SplineWeights& w) {
  SplineWeights result;
  for (int a = 0; a < 3; ++a) {
    result.value[a] = w.value[a] * w.value[a];
    result.slope[a] = w.slope[a] * w.slope[a];
  }
  return result;
}

// The sums of a block's cube go to the level's.
void put_down(const BlockLevel& level, const BlockPlace& place, std::array<double, cube_size>& cube,
              std::vector<double>& sum) {
  if (place == nowhere) return;
  const std::int32_t block = level.find(place);
  for (int i = 0; i < cube_size; ++i)
    if (cube[i] != 0)
      sum[place_in_level(level, block, i % cube_width, i / cube_width % cube_width,
                         i / (cube_width * cube_width))] += cube[i];
  cube.fill(0);
}

// Products of two of a cell's three functions along an axis: one for each pair.
constexpr int pairs = 6;
constexpr int pair_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

struct PairProducts {
  std::array<double, pairs> value, slope;
};

PairProducts pair_products(const SplineWeights& w) {
  PairProducts p;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      p.value[pair_of[a][b]] = w.value[a] * w.value[b];
      p.slope[pair_of[a][b]] = w.slope[a] * w.slope[b];
    }
  return p;
}

// The matrix of a cell's 27 functions has 6^3 different entries: each is a product over the axes.
using CellMatrix = std::array<double, pairs * pairs * pairs>;

void add_sample(const CellWeights& w, double value_factor, double slope_factor, CellMatrix& sum) {
  const PairProducts x = pair_products(w.x), y = pair_products(w.y), z = pair_products(w.z);
  double* to = sum.data();
  for (int c = 0; c < pairs; ++c)
    for (int b = 0; b < pairs; ++b, to += pairs) {
      const double by_slope = slope_factor * y.value[b] * z.value[c];
      const double by_value = value_factor * y.value[b] * z.value[c] +
                              slope_factor * (y.slope[b] * z.value[c] + y.value[b] * z.slope[c]);
      for (int a = 0; a < pairs; ++a) to[a] += by_value * x.value[a] + by_slope * x.slope[a];
    }
}

void put_down(const BlockLevel& level, const BlockPlace& cell, std::span<const std::int32_t> row_of,
              CellMatrix& sum, Eigen::MatrixXd& matrix) {
  if (cell == nowhere) return;
  const std::int32_t block = level.find(block_of(cell));
  std::array<std::int32_t, 27> rows;
  for (int i = 0; i < 27; ++i)
    rows[i] = row_of[place_in_level(level, block, cell[0] % 4 + i % 3, cell[1] % 4 + i / 3 % 3,
                                    cell[2] % 4 + i / 9)];
  for (int j = 0; j < 27; ++j)
    for (int i = 0; i < 27; ++i)
      matrix(rows[i], rows[j]) +=
          sum[pair_of[i % 3][j % 3] +
              pairs * (pair_of[i / 3 % 3][j / 3 % 3] + pairs * pair_of[i / 9][j / 9])];
  sum.fill(0);
}

}  // namespace

void add_sample_diagonal(const BlockLevel& level, const Samples& samples,
                         const SampleWeights& weights, std::span<const std::uint32_t> chosen,
                         std::vector<double>& sum) {
  const double cells = level.cells();
  BlockPlace held = nowhere;
  std::array<double, cube_size> cube{};
  for (const std::uint32_t i : chosen) {
    const BlockPlace cell = cell_at(samples.points[i], level.cells());
    if (const BlockPlace block = block_of(cell); block != held) {
      put_down(level, held, cube, sum);
      held = block;
    }
    // Squares of products are products of squares.
    const CellWeights w = weights_in(cell, samples.points[i], cells);
    accumulate(cube.data() + cube_corner(cell), {squares(w.x), squares(w.y), squares(w.z)},
               {weights.value[i], Eigen::Vector3d::Constant(weights.gradient[i] * cells * cells)});
  }
  put_down(level, held, cube, sum);
}

void add_sample_matrix(const BlockLevel& level, const Samples& samples,
                       const SampleWeights& weights, std::span<const std::uint32_t> chosen,
                       std::span<const std::int32_t> row_of, Eigen::MatrixXd& matrix) {
  const double cells = level.cells();
  BlockPlace held = nowhere;
  CellMatrix sum{};
  for (const std::uint32_t i : chosen) {
    const BlockPlace cell = cell_at(samples.points[i], level.cells());
    if (cell != held) {
      put_down(level, held, row_of, sum, matrix);
      held = cell;
    }
    add_sample(weights_in(cell, samples.points[i], cells), weights.value[i],
               weights.gradient[i] * cells * cells, sum);
  }
  put_down(level, held, row_of, sum, matrix);
}

}  // namespace scan
