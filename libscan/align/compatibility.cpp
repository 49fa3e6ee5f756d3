// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/compatibility.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libscan/align/bit_kernels.h"
#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t tile = tile_width;

// Coordinates in single precision about the mean, in units of the extent, each in an array of its
// own, filled up to whole tiles.
struct Columns {
  std::array<std::vector<float>, 3> source, target, source_normal, target_normal;
};

void fill(std::array<std::vector<float>, 3>& columns, std::span<const Correspondence> all,
          Eigen::Vector3d Correspondence::*field, const Eigen::Vector3d& origin, double scale) {
  for (int axis = 0; axis < 3; ++axis) {
    columns[axis].assign((all.size() + tile - 1) / tile * tile, 0);
    for (std::size_t i = 0; i < all.size(); ++i)
      columns[axis][i] = static_cast<float>(((all[i].*field)[axis] - origin[axis]) * scale);
  }
}

double extent_m(std::span<const Correspondence> all, Eigen::Vector3d Correspondence::*field,
                Eigen::Vector3d& centre) {
  Eigen::Vector3d least = all[0].*field, most = least;
  for (const Correspondence& one : all) {
    least = least.cwiseMin(one.*field);
    most = most.cwiseMax(one.*field);
  }
  centre = (least + most) / 2;
  return (most - least).norm();
}

// Transposes 64 x 64 bits: halves are exchanged across the diagonal, then quarters, and so on
// (Warren, Hacker's Delight, 7-3).
void transpose(std::array<std::uint64_t, tile>& rows) {
  std::uint64_t mask = 0x00000000ffffffffu;
  for (std::size_t step = 32; step != 0; step /= 2, mask ^= mask << step)
    for (std::size_t k = 0; k < tile; k = (k + step + 1) & ~step) {
      const std::uint64_t moved = ((rows[k] >> step) ^ rows[k + step]) & mask;
      rows[k] ^= moved << step;
      rows[k + step] ^= moved;
    }
}

TileColumns columns_from(const Columns& columns, std::size_t first) {
  const auto at = [&](const std::array<std::vector<float>, 3>& c) {
    return std::array<const float*, 3>{&c[0][first], &c[1][first], &c[2][first]};
  };
  return {at(columns.source), at(columns.target), at(columns.source_normal),
          at(columns.target_normal)};
}

void fill_tile(const Columns& columns, std::size_t row, std::size_t column,
               const TileLimits& limits, BitGraph& graph) {
  std::array<std::uint64_t, tile> bits{};
  const TileColumns a = columns_from(columns, row * tile);
  const TileColumns b = columns_from(columns, column * tile);
  const std::size_t rows = std::min(tile, graph.size() - row * tile);
  const std::size_t used = std::min(tile, graph.size() - column * tile);
  const std::uint64_t valid = used == tile ? ~std::uint64_t{0} : (std::uint64_t{1} << used) - 1;
  compare_tile(a, b, rows, limits, bits);
  for (std::size_t i = 0; i < rows; ++i) {
    bits[i] &= valid;
    if (row == column) bits[i] &= ~(std::uint64_t{1} << i);
    graph.row(row * tile + i)[column] = bits[i];
  }
  if (row == column) return;
  transpose(bits);
  for (std::size_t j = 0; j < used; ++j) graph.row(column * tile + j)[row] = bits[j];
}

}  // namespace

BitGraph::BitGraph(std::size_t size)
    : size_(size), words_((size + 63) / 64), bits_(size * words_, 0) {}

void BitGraph::join(std::size_t i, std::size_t j) {
  row(i)[j / 64] |= std::uint64_t{1} << (j % 64);
  row(j)[i / 64] |= std::uint64_t{1} << (i % 64);
}

std::size_t BitGraph::degree(std::size_t i) const {
  return common_bits(row(i).data(), row(i).data(), words_);
}

BitGraph compatibility(std::span<const Correspondence> correspondences,
                       const CompatibilityLimits& limits) {
  BitGraph graph(correspondences.size());
  if (correspondences.empty()) return graph;
  Eigen::Vector3d source_centre, target_centre;
  const double extent = std::max(extent_m(correspondences, &Correspondence::source, source_centre),
                                 extent_m(correspondences, &Correspondence::target, target_centre));
  if (!(extent > 0)) return graph;
  Columns columns;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  fill(columns.source, correspondences, &Correspondence::source, source_centre, 1 / extent);
  fill(columns.target, correspondences, &Correspondence::target, target_centre, 1 / extent);
  fill(columns.source_normal, correspondences, &Correspondence::source_normal, zero, 1);
  fill(columns.target_normal, correspondences, &Correspondence::target_normal, zero, 1);
  const auto squared = [&](double x_m) {
    return static_cast<float>(x_m * x_m / (extent * extent));
  };
  const TileLimits local{squared(limits.distance_m), squared(limits.least_distance_m),
                         static_cast<float>(limits.cosine)};
  const std::size_t tiles = graph.words();
  parallel_for(
      tiles,
      [&](std::size_t row) {
        for (std::size_t column = row; column < tiles; ++column)
          fill_tile(columns, row, column, local, graph);
      },
      1);
  return graph;
}

}  // namespace scan
