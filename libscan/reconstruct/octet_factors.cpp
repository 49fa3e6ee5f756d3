// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/octet_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/cell_weights.h"

namespace scan {
namespace {

using OctetMatrices = std::array<Eigen::Matrix<double, 8, 8>, 8>;

constexpr std::size_t blocks_per_task = 16;
constexpr std::int32_t shared = 0;

// Of a function of a block, bits x, y, z: its octet, and its place there.
int octet_of(int x, int y, int z) {
  return x / 2 + 2 * (y / 2) + 4 * (z / 2);
}
int place_of(int x, int y, int z) {
  return x % 2 + 2 * (y % 2) + 4 * (z % 2);
}

OctetMatrices bending_matrices(const BlockLevel& level, const BendingStencil& bending,
                               std::size_t block) {
  OctetMatrices matrices;
  for (auto& matrix : matrices) matrix.setZero();
  for (int slot = 0; slot < block_size; ++slot) {
    const int x = slot % 4, y = slot / 4 % 4, z = slot / 16;
    const int octet = octet_of(x, y, z), row = place_of(x, y, z);
    auto& matrix = matrices[static_cast<std::size_t>(octet)];
    bending.for_row(level, block * block_size + static_cast<std::size_t>(slot),
                    [&](std::size_t function, double entry) {
                      if (function / block_size != block) return;
                      const int other = static_cast<int>(function % block_size);
                      const int ox = other % 4, oy = other / 4 % 4, oz = other / 16;
                      if (octet_of(ox, oy, oz) == octet) matrix(place_of(ox, oy, oz), row) += entry;
                    });
    if (matrix(row, row) == 0) matrix(row, row) = 1;  // outside the cube
  }
  return matrices;
}

// Adds v B B' + g grad B . grad B' of the functions B of a sample's cell, lower halves only.
// `first`: the cell's first function from the block's.
void add_sample(const CellWeights<double>& w, double value_weight, double slope_weight,
                const BlockPlace& first, OctetMatrices& matrices) {
  struct OfOctet {
    int count = 0;
    int place[8];
    Eigen::Vector4d value_and_slope[8];
  };
  std::array<OfOctet, 8> octets;
  const double value_root = std::sqrt(value_weight), slope_root = std::sqrt(slope_weight);
  const auto in_block = [&](int axis) {  // of the cell's three functions along it
    return std::pair(std::max(0, -first[axis]), std::min(3, block_width - first[axis]));
  };
  const auto [x_begin, x_end] = in_block(0);
  const auto [y_begin, y_end] = in_block(1);
  const auto [z_begin, z_end] = in_block(2);
  for (int c = z_begin; c < z_end; ++c)
    for (int b = y_begin; b < y_end; ++b) {
      const double value = w.y.value[b] * w.z.value[c], along_y = w.y.slope[b] * w.z.value[c],
                   along_z = w.y.value[b] * w.z.slope[c];
      for (int a = x_begin; a < x_end; ++a) {
        const int x = first[0] + a, y = first[1] + b, z = first[2] + c;
        OfOctet& octet = octets[static_cast<std::size_t>(octet_of(x, y, z))];
        octet.place[octet.count] = place_of(x, y, z);
        octet.value_and_slope[octet.count++] = {
            value_root * w.x.value[a] * value, slope_root * w.x.slope[a] * value,
            slope_root * w.x.value[a] * along_y, slope_root * w.x.value[a] * along_z};
      }
    }
  for (std::size_t o = 0; o < 8; ++o)
    for (int j = 0; j < octets[o].count; ++j)
      for (int i = j; i < octets[o].count; ++i)
        matrices[o](octets[o].place[i], octets[o].place[j]) +=
            octets[o].value_and_slope[i].dot(octets[o].value_and_slope[j]);
}

// Calls visit(samples, offset of their block) for the blocks whose cells reach the block's
// functions.
template <class Visit>
void for_samples_around(const BlockLevel& level, std::span<const CellSample> placed,
                        std::size_t block, Visit&& visit) {
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
    const std::int32_t from = level.neighbours[block][neighbour_slot(-dx, -dy, -dz)];
    if (from < 0) continue;
    const auto samples = of_block(placed, static_cast<std::size_t>(from));
    if (!samples.empty()) visit(samples, BlockPlace{-4 * dx, -4 * dy, -4 * dz});
  }
}

}  // namespace

OctetFactors::OctetFactors(const BlockLevel& level, const BendingStencil& bending,
                           const Samples& samples, const SampleWeights& weights,
                           std::span<const CellSample> placed)
    : factors_of_(level.active, shared) {
  std::vector<char> has_samples(level.active, 0);
  parallel_for(level.active, [&](std::size_t b) {
    for_samples_around(level, placed, b, [&](auto&&...) { has_samples[b] = 1; });
  });
  std::vector<std::size_t> block_of(1, level.active);
  OctetMatrices of_inner;
  for (auto& matrix : of_inner) matrix.setIdentity();
  for (std::size_t b = 0; b < level.active; ++b) {
    const bool is_inner = level.is_inner(b);
    if (is_inner && block_of.front() == level.active) {
      block_of.front() = b;
      of_inner = bending_matrices(level, bending, b);
    }
    if (is_inner && !has_samples[b]) continue;
    factors_of_[b] = static_cast<std::int32_t>(block_of.size());
    block_of.push_back(b);
  }
  factors_.resize(block_of.size());
  const double cells = level.cells();
  parallel_for(
      block_of.size(),
      [&](std::size_t k) {
        const std::size_t b = block_of[k];
        OctetMatrices matrices = of_inner;
        if (k != shared) {
          if (!level.is_inner(b)) matrices = bending_matrices(level, bending, b);
          for_samples_around(level, placed, b, [&](auto found, const BlockPlace& from) {
            for (const CellSample& at : found) {
              const Eigen::Vector3d& u = samples.points[at.sample];
              const BlockPlace cell = cell_at(u, level.cells());
              const Eigen::Vector3d in_cell =
                  u * cells - Eigen::Vector3d(cell[0], cell[1], cell[2]);
              add_sample(weights_at(in_cell), weights.value[at.sample],
                         weights.gradient[at.sample] * cells * cells,
                         {from[0] + cell[0] % 4, from[1] + cell[1] % 4, from[2] + cell[2] % 4},
                         matrices);
            }
          });
        }
        for (std::size_t o = 0; o < 8; ++o) factors_[k][o] = packed_cholesky<8>(matrices[o]);
      },
      blocks_per_task);
}

template <class Real>
void OctetFactors::solve(std::size_t block, const Real* r, Real* z) const {
  const auto& factors = factors_[static_cast<std::size_t>(factors_of_[block])];
  for (int o = 0; o < 8; ++o) {
    const int first = slot_in_block(2 * (o & 1), 2 * (o >> 1 & 1), 2 * (o >> 2));
    const auto slot = [&](int i) { return first + slot_in_block(i & 1, i >> 1 & 1, i >> 2); };
    Eigen::Matrix<float, 8, 1> x;
    for (int i = 0; i < 8; ++i) x[i] = static_cast<float>(r[slot(i)]);
    solve_packed<8>(factors[static_cast<std::size_t>(o)], x);
    for (int i = 0; i < 8; ++i) z[slot(i)] = x[i];
  }
}

template void OctetFactors::solve(std::size_t, const float*, float*) const;
template void OctetFactors::solve(std::size_t, const double*, double*) const;

}  // namespace scan
