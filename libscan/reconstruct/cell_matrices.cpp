// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cell_matrices.h"

#include <algorithm>
#include <tuple>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/cell_weights.h"

namespace scan {
namespace {

constexpr std::size_t cells_per_task = 32;

BlockPlace place_of_cell(const BlockLevel& level, std::uint32_t cell) {
  const BlockPlace& block = level.blocks[cell / block_size];
  const int slot = static_cast<int>(cell % block_size);
  return {block_width * block[0] + slot % 4, block_width * block[1] + slot / 4 % 4,
          block_width * block[2] + slot / 16};
}

struct PairProducts {
  std::array<double, axis_pairs> value, slope;
};

PairProducts pair_products(const SplineWeights<double>& w) {
  PairProducts p;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      p.value[pair_of[a][b]] = w.value[a] * w.value[b];
      p.slope[pair_of[a][b]] = w.slope[a] * w.slope[b];
    }
  return p;
}

void add_sample(const CellWeights<double>& w, double value_factor, double slope_factor,
                CellMatrix& sum) {
  const PairProducts x = pair_products(w.x), y = pair_products(w.y), z = pair_products(w.z);
  double* to = sum.data();
  for (int c = 0; c < axis_pairs; ++c)
    for (int b = 0; b < axis_pairs; ++b, to += axis_pairs) {
      const double by_slope = slope_factor * y.value[b] * z.value[c];
      const double by_value = value_factor * y.value[b] * z.value[c] +
                              slope_factor * (y.slope[b] * z.value[c] + y.value[b] * z.slope[c]);
      for (int a = 0; a < axis_pairs; ++a) to[a] += by_value * x.value[a] + by_slope * x.slope[a];
    }
}

// A coarse cell's three functions along an axis as sums of those of its lower and upper half.
constexpr double halves[2][3][3] = {{{0.75, 0.25, 0}, {0.25, 0.75, 0.75}, {0, 0, 0.25}},
                                    {{0.25, 0, 0}, {0.75, 0.75, 0.25}, {0, 0.25, 0.75}}};

// The same for their pairs: [half][fine pair][coarse pair].
struct PairRefinement {
  double of[2][axis_pairs][axis_pairs] = {};
  constexpr PairRefinement() {
    for (int half = 0; half < 2; ++half)
      for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j)
          for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
              of[half][pair_of[a][b]][pair_of[i][j]] += halves[half][i][a] * halves[half][j][b];
  }
};
constexpr PairRefinement refinement;

// sum += `fine` of the child `octant` (bits x, y, z), one axis after the other.
void add_child(const CellMatrix& fine, int octant, CellMatrix& sum) {
  constexpr int n = axis_pairs;
  const auto& x = refinement.of[octant & 1];
  const auto& y = refinement.of[octant >> 1 & 1];
  const auto& z = refinement.of[octant >> 2];
  CellMatrix by_z{}, by_y{};
  for (int c = 0; c < n; ++c)
    for (int to = 0; to < n; ++to)
      for (int k = 0; k < n * n; ++k) by_z[k + n * n * to] += z[c][to] * fine[k + n * n * c];
  for (int c = 0; c < n; ++c)
    for (int b = 0; b < n; ++b)
      for (int to = 0; to < n; ++to)
        for (int k = 0; k < n; ++k)
          by_y[k + n * (to + n * c)] += y[b][to] * by_z[k + n * (b + n * c)];
  for (int line = 0; line < n * n; ++line)
    for (int a = 0; a < n; ++a)
      for (int to = 0; to < n; ++to) sum[to + n * line] += x[a][to] * by_y[a + n * line];
}

struct Child {
  std::uint32_t parent, octant, index;
  bool operator<(const Child& other) const {
    return std::tie(parent, index) < std::tie(other.parent, other.index);
  }
};

std::vector<Child> children_of_cells(const OctreeGrid& grid, std::size_t l,
                                     const CellMatrices& finer) {
  const BlockLevel& level = grid.levels[l + 1];
  std::vector<Child> children(finer.cells.size());
  for (std::uint32_t i = 0; i < children.size(); ++i) {
    const BlockPlace p = place_of_cell(level, finer.cells[i]);
    const auto block = static_cast<std::uint32_t>(level.parent[finer.cells[i] / block_size]);
    const int slot = slot_in_block(p[0] / 2 % 4, p[1] / 2 % 4, p[2] / 2 % 4);
    children[i] = {block * block_size + static_cast<std::uint32_t>(slot),
                   static_cast<std::uint32_t>(p[0] % 2 + 2 * (p[1] % 2) + 4 * (p[2] % 2)), i};
  }
  std::sort(children.begin(), children.end());
  return children;
}

}  // namespace

CellMatrices cell_matrices(const BlockLevel& level, const Samples& samples,
                           const SampleWeights& weights, std::span<const CellSample> placed) {
  CellMatrices result;
  std::vector<std::size_t> begin;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (i == 0 || placed[i].cell != placed[i - 1].cell) {
      result.cells.push_back(placed[i].cell);
      begin.push_back(i);
    }
  begin.push_back(placed.size());
  result.matrices.resize(result.cells.size());
  const double cells = level.cells();
  parallel_for(
      result.cells.size(),
      [&](std::size_t k) {
        const BlockPlace cell = place_of_cell(level, result.cells[k]);
        result.matrices[k].fill(0);
        for (std::size_t i = begin[k]; i < begin[k + 1]; ++i) {
          const std::uint32_t s = placed[i].sample;
          const Eigen::Vector3d in_cell =
              samples.points[s] * cells - Eigen::Vector3d(cell[0], cell[1], cell[2]);
          add_sample(weights_at(in_cell), weights.value[s], weights.gradient[s] * cells * cells,
                     result.matrices[k]);
        }
      },
      cells_per_task);
  return result;
}

CellMatrices coarsened(const OctreeGrid& grid, std::size_t l, const CellMatrices& finer,
                       const CellMatrices& own) {
  const std::vector<Child> children = children_of_cells(grid, l, finer);
  CellMatrices result;
  result.cells = own.cells;
  for (const Child& child : children) result.cells.push_back(child.parent);
  std::sort(result.cells.begin(), result.cells.end());
  result.cells.erase(std::unique(result.cells.begin(), result.cells.end()), result.cells.end());
  result.matrices.resize(result.cells.size());
  parallel_for(
      result.cells.size(),
      [&](std::size_t k) {
        const std::uint32_t cell = result.cells[k];
        const auto mine = std::lower_bound(own.cells.begin(), own.cells.end(), cell);
        if (mine != own.cells.end() && *mine == cell)
          result.matrices[k] = own.matrices[static_cast<std::size_t>(mine - own.cells.begin())];
        else
          result.matrices[k].fill(0);
        for (auto child = std::lower_bound(children.begin(), children.end(), Child{cell, 0, 0});
             child != children.end() && child->parent == cell; ++child)
          add_child(finer.matrices[child->index], static_cast<int>(child->octant),
                    result.matrices[k]);
      },
      cells_per_task);
  return result;
}

void add_dense(const BlockLevel& level, const CellMatrices& term,
               std::span<const std::int32_t> row_of, Eigen::MatrixXd& matrix) {
  for (std::size_t k = 0; k < term.cells.size(); ++k) {
    const BlockPlace cell = place_of_cell(level, term.cells[k]);
    std::array<std::int32_t, 27> rows;
    for (int i = 0; i < 27; ++i) {
      const int x = cell[0] + i % 3, y = cell[1] + i / 3 % 3, z = cell[2] + i / 9;
      const auto block = static_cast<std::size_t>(level.find({x / 4, y / 4, z / 4}));
      rows[i] =
          row_of[block * block_size + static_cast<std::size_t>(slot_in_block(x % 4, y % 4, z % 4))];
    }
    for (int j = 0; j < 27; ++j)
      for (int i = 0; i < 27; ++i) matrix(rows[i], rows[j]) += entry(term.matrices[k], i, j);
  }
}

}  // namespace scan
