// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_system.h"

#include <algorithm>
#include <numeric>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/sample_matrix.h"
#include "libscan/search/batch.h"

namespace scan {

SsdSystem::SsdSystem(const OctreeGrid& grid, const Samples& samples, SampleWeights weights)
    : grid_(grid),
      samples_(samples),
      depths_(depths_seen(grid, samples.points)),
      order_(curve_order(samples.points)),
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

LevelArrays SsdSystem::diagonal() const {
  LevelArrays result = active_arrays(grid_);
  const auto of_level = [&](std::size_t l) {
    const BlockLevel& level = grid_.levels[l];
    std::vector<std::uint32_t> chosen;  // a level's functions meet the samples of finer levels too
    for (const std::uint32_t i : order_)
      if (depths_[i] >= level.depth) chosen.push_back(i);
    std::vector<double> sum(level.blocks.size() * block_size, 0.0);
    add_sample_diagonal(level, samples_, weights_, chosen, sum);
    parallel_for(level.active, [&](std::size_t b) {
      for (int slot = 0; slot < block_size; ++slot) {
        const std::size_t i = b * block_size + slot;
        const double entry = sum[i] + bending_[l].diagonal(level.blocks[b], slot);
        result[l][i] = entry > 0 ? entry : 1;
      }
    });
  };
  parallel_for(finest_ + 1, of_level, 1);
  return result;
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

Eigen::MatrixXd SsdSystem::coarsest_matrix() const {
  const BlockLevel& level = grid_.levels.front();
  const std::vector<std::uint32_t> functions = coarsest_functions();
  const std::size_t size = functions.size();
  std::vector<std::int32_t> row_of(level.active * block_size, -1);
  for (std::size_t row = 0; row < size; ++row)
    row_of[functions[row]] = static_cast<std::int32_t>(row);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  add_sample_matrix(level, samples_, weights_, order_, row_of, matrix);
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
