// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_system.h"

#include <algorithm>
#include <numeric>

#include "libscan/core/parallel.h"

namespace scan {

SsdSystem::SsdSystem(const OctreeGrid& grid, const Samples& samples, SampleWeights weights)
    : grid_(grid),
      samples_(samples),
      depths_(depths_seen(grid, samples.points)),
      weights_(std::move(weights)),
      terms_(grid.levels.size()) {
  for (const BlockLevel& level : grid.levels) {
    bending_.emplace_back(level.depth);
    sums_.emplace_back(level.blocks.size() * block_size, 0.0);
    residuals_.emplace_back(level.blocks.size() * block_size, 0.0);
  }
  use_levels(grid.levels.size() - 1);
}

void SsdSystem::set_weights(SampleWeights weights) {
  weights_ = std::move(weights);
  for (std::size_t l = 0; l <= finest_; ++l) terms_[l].set_weights(weights_);
}

void SsdSystem::use_levels(std::size_t finest) {
  finest_ = finest;
  std::vector<std::vector<std::uint32_t>> chosen(finest + 1);
  for (std::uint32_t i = 0; i < depths_.size(); ++i)
    chosen[std::min<std::size_t>(depths_[i] - coarsest_depth, finest)].push_back(i);
  for (std::size_t l = 0; l <= finest; ++l)
    terms_[l] = SampleTerm(grid_.levels[l], samples_, weights_, chosen[l]);
  if (finest > 0) {
    std::vector<std::uint32_t>& last = chosen[finest - 1];
    last.insert(last.end(), chosen[finest].begin(), chosen[finest].end());
  }
  in_cells_.clear();
  for (std::size_t l = 0; l < std::max<std::size_t>(finest, 1); ++l)
    in_cells_.push_back(in_cells(grid_.levels[l], samples_, chosen[l]));
}

void SsdSystem::accumulate_coarse_to_fine(const LevelArrays& x) {
  for (std::size_t l = 0; l <= finest_; ++l) {
    if (l > 0)
      prolong(grid_, l, sums_[l - 1], sums_[l]);
    else
      std::fill(sums_[0].begin(), sums_[0].end(), 0.0);
    for (std::size_t i = 0; i < x[l].size(); ++i) sums_[l][i] += x[l][i];
  }
}

void SsdSystem::multiply(const LevelArrays& x, LevelArrays& y, bool with_samples) {
  accumulate_coarse_to_fine(x);
  for (std::size_t l = finest_ + 1; l-- > 0;) {
    const BlockLevel& level = grid_.levels[l];
    std::vector<double>& rest = residuals_[l];
    std::fill(rest.begin(), rest.end(), 0.0);
    if (l < finest_) restrict_add(grid_, l, residuals_[l + 1], rest);
    if (with_samples) terms_[l].add_product(level, sums_[l], rest);
    parallel_for(level.active, [&](std::size_t b) {
      std::copy_n(rest.data() + b * block_size, block_size, y[l].data() + b * block_size);
      bending_[l].add(level, sums_[l], b, 1, y[l].data() + b * block_size);
    });
    // Coarser levels have seen their own part of `sums_`: they lack what this level adds.
    if (l > 0)
      parallel_for(level.blocks.size(), [&](std::size_t b) {
        bending_[l].add(level, x[l], b, 1, rest.data() + b * block_size);
      });
  }
}

LevelArrays SsdSystem::right_side() {
  LevelArrays b = active_arrays(grid_);
  for (std::size_t l = finest_ + 1; l-- > 0;) {
    std::vector<double>& rest = residuals_[l];
    std::fill(rest.begin(), rest.end(), 0.0);
    if (l < finest_) restrict_add(grid_, l, residuals_[l + 1], rest);
    terms_[l].add_right_side(grid_.levels[l], rest);
    std::copy_n(rest.begin(), b[l].size(), b[l].begin());
  }
  return b;
}

std::vector<double> SsdSystem::finest_diagonal() const {
  const BlockLevel& level = grid_.levels[finest_];
  std::vector<double> diagonal(level.blocks.size() * block_size, 0.0);
  terms_[finest_].add_diagonal(level, diagonal);
  diagonal.resize(level.active * block_size);
  parallel_for(level.active, [&](std::size_t b) {
    for (int slot = 0; slot < block_size; ++slot) {
      double& entry = diagonal[b * block_size + static_cast<std::size_t>(slot)];
      entry += bending_[finest_].diagonal(level.blocks[b], slot);
      if (!(entry > 0)) entry = 1;
    }
  });
  return diagonal;
}

CellMatrices SsdSystem::sample_matrices(std::size_t l, const CellMatrices& finer) const {
  CellMatrices own = cell_matrices(grid_.levels[l], samples_, weights_, in_cells_[l]);
  if (l + 1 == in_cells_.size()) return own;
  return coarsened(grid_, l, finer, own);
}

std::vector<std::uint32_t> SsdSystem::coarsest_functions() const {
  const BlockLevel& level = grid_.levels.front();
  std::vector<std::uint32_t> functions;
  for (std::uint32_t i = 0; i < level.active * block_size; ++i) {
    const BlockPlace& p = level.blocks[i / block_size];
    const int slot = static_cast<int>(i % block_size), last = level.cells() + 1;
    if (block_width * p[0] + slot % 4 <= last && block_width * p[1] + slot / 4 % 4 <= last &&
        block_width * p[2] + slot / 16 <= last)
      functions.push_back(i);
  }
  return functions;
}

Eigen::MatrixXd SsdSystem::coarsest_matrix(const CellMatrices& samples) const {
  const BlockLevel& level = grid_.levels.front();
  const std::vector<std::uint32_t> functions = coarsest_functions();
  const std::size_t size = functions.size();
  std::vector<std::int32_t> row_of(level.active * block_size, -1);
  for (std::size_t row = 0; row < size; ++row)
    row_of[functions[row]] = static_cast<std::int32_t>(row);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  add_dense(level, samples, row_of, matrix);
  for (std::size_t row = 0; row < size; ++row)
    bending_[0].for_row(level, functions[row], [&](std::size_t function, double entry) {
      if (row_of[function] >= 0) matrix(row_of[function], row) += entry;  // it is symmetric
    });
  return matrix;
}

std::vector<double> SsdSystem::residuals(const LevelArrays& x) {
  accumulate_coarse_to_fine(x);
  std::vector<double> found(depths_.size(), 0.0);
  for (std::size_t l = 0; l <= finest_; ++l)
    terms_[l].write_residuals(grid_.levels[l], sums_[l], found);
  return found;
}

void SsdSystem::aim_at_scattered_mean(const LevelArrays& x) {
  accumulate_coarse_to_fine(x);
  for (std::size_t l = 0; l <= finest_; ++l)
    terms_[l].aim_at_scattered_mean(grid_.levels[l], sums_[l], samples_.sigma);
}

double SsdSystem::energy(const LevelArrays& x) {
  LevelArrays product = active_arrays(grid_);
  multiply(x, product, false);  // leaves the sums behind
  double total = 0;
  for (std::size_t l = 0; l <= finest_; ++l) {
    total += terms_[l].energy(grid_.levels[l], sums_[l]);
    total += std::inner_product(x[l].begin(), x[l].end(), product[l].begin(), 0.0);
  }
  return total;
}

}  // namespace scan
