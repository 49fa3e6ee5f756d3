// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/ssd_system.h"

#include <algorithm>
#include <numeric>

#include "libscan/core/parallel.h"

namespace scan {
namespace {

constexpr std::size_t chunk = 4096;

}  // namespace

template <class Real>
SsdSystem<Real>::SsdSystem(const OctreeGrid& grid, const Samples& samples, SampleWeights weights)
    : grid_(grid),
      samples_(samples),
      depths_(depths_seen(grid, samples.points)),
      weights_(std::move(weights)),
      terms_(grid.levels.size()) {
  for (const BlockLevel& level : grid.levels) {
    bending_.emplace_back(level.depth);
    sums_.emplace_back(level.blocks.size() * block_size);
    residuals_.emplace_back(level.blocks.size() * block_size);
  }
  use_levels(grid.levels.size() - 1);
}

template <class Real>
void SsdSystem<Real>::set_weights(SampleWeights weights) {
  weights_ = std::move(weights);
  for (std::size_t l = 0; l <= finest_; ++l) terms_[l].set_weights(weights_);
}

template <class Real>
void SsdSystem<Real>::use_levels(std::size_t finest) {
  finest_ = finest;
  std::vector<std::vector<std::uint32_t>> chosen(finest + 1);
  for (std::uint32_t i = 0; i < depths_.size(); ++i)
    chosen[std::min<std::size_t>(depths_[i] - coarsest_depth, finest)].push_back(i);
  for (std::size_t l = 0; l <= finest; ++l)
    terms_[l] = SampleTerm<Real>(grid_.levels[l], samples_, weights_, chosen[l]);
  const auto join_to = [&](std::size_t l) {
    chosen[l].insert(chosen[l].end(), chosen[l + 1].begin(), chosen[l + 1].end());
    chosen[l + 1] = {};
  };
  in_octet_cells_ = {};
  if (finest > 0) join_to(finest - 1);
  if (finest > 1) {
    in_octet_cells_ = in_cells(grid_.levels[finest - 1], samples_, chosen[finest - 1]);
    join_to(finest - 2);
  }
  in_cells_.clear();
  for (std::size_t l = 0; l < levels_of_blocks(); ++l)
    in_cells_.push_back(in_cells(grid_.levels[l], samples_, chosen[l]));
}

template <class Real>
template <class Coefficients>
void SsdSystem<Real>::accumulate_coarse_to_fine(const Coefficients& x) {
  for (std::size_t l = 0; l <= finest_; ++l) {
    if (l > 0)
      prolong(grid_, l, sums_[l - 1], sums_[l]);
    else
      std::fill(sums_[0].begin(), sums_[0].end(), Real{0});
    parallel_for(
        x[l].size(), [&](std::size_t i) { sums_[l][i] += static_cast<Real>(x[l][i]); }, chunk);
  }
}

template <class Real>
void SsdSystem<Real>::multiply(const Arrays& x, Arrays& y, bool with_samples) {
  accumulate_coarse_to_fine(x);
  for (std::size_t l = finest_ + 1; l-- > 0;) {
    const BlockLevel& level = grid_.levels[l];
    std::vector<Real>& rest = residuals_[l];
    std::fill(rest.begin(), rest.end(), Real{0});
    if (l < finest_) restrict_add(grid_, l, residuals_[l + 1], rest);
    if (with_samples) terms_[l].add_product(level, sums_[l], rest);
    parallel_for(level.active, [&](std::size_t b) {
      std::copy_n(rest.data() + b * block_size, block_size, y[l].data() + b * block_size);
      bending_[l].add(level, sums_[l], b, y[l].data() + b * block_size);
    });
    // Coarser levels have seen their own part of `sums_`: they lack what this level adds.
    if (l > 0)
      parallel_for(level.blocks.size(), [&](std::size_t b) {
        bending_[l].add(level, x[l], b, rest.data() + b * block_size);
      });
  }
}

template <class Real>
void SsdSystem<Real>::right_side(Arrays& b) {
  for (std::size_t l = finest_ + 1; l-- > 0;) {
    std::vector<Real>& rest = residuals_[l];
    std::fill(rest.begin(), rest.end(), Real{0});
    if (l < finest_) restrict_add(grid_, l, residuals_[l + 1], rest);
    terms_[l].add_right_side(grid_.levels[l], rest);
    std::copy_n(rest.begin(), b[l].size(), b[l].begin());
  }
}

template <class Real>
std::vector<Real> SsdSystem<Real>::finest_diagonal() {
  const BlockLevel& level = grid_.levels[finest_];
  std::vector<Real>& of_samples = residuals_[finest_];
  std::fill(of_samples.begin(), of_samples.end(), Real{0});
  terms_[finest_].add_diagonal(level, of_samples);
  std::vector<Real> diagonal(level.active * block_size);
  parallel_for(level.active, [&](std::size_t b) {
    for (int slot = 0; slot < block_size; ++slot) {
      const std::size_t i = b * block_size + static_cast<std::size_t>(slot);
      diagonal[i] =
          of_samples[i] + static_cast<Real>(bending_[finest_].diagonal(level.blocks[b], slot));
      if (!(diagonal[i] > 0)) diagonal[i] = 1;
    }
  });
  return diagonal;
}

template <class Real>
OctetFactors SsdSystem<Real>::octet_factors() const {
  return OctetFactors(grid_.levels[finest_ - 1], bending_[finest_ - 1], samples_, weights_,
                      in_octet_cells_);
}

template <class Real>
CellMatrices SsdSystem<Real>::sample_matrices(std::size_t l, const CellMatrices& finer) const {
  CellMatrices own = cell_matrices(grid_.levels[l], samples_, weights_, in_cells_[l]);
  if (l + 1 == in_cells_.size()) return own;
  return coarsened(grid_, l, finer, own);
}

template <class Real>
std::vector<std::uint32_t> SsdSystem<Real>::coarsest_functions() const {
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

template <class Real>
Eigen::MatrixXd SsdSystem<Real>::coarsest_matrix(const CellMatrices& samples) const {
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

template <class Real>
std::vector<double> SsdSystem<Real>::residuals(const LevelArrays& x) {
  accumulate_coarse_to_fine(x);
  std::vector<double> found(depths_.size(), 0.0);
  for (std::size_t l = 0; l <= finest_; ++l)
    terms_[l].write_residuals(grid_.levels[l], sums_[l], found);
  return found;
}

template <class Real>
void SsdSystem<Real>::aim_at_scattered_mean(const LevelArrays& x) {
  accumulate_coarse_to_fine(x);
  for (std::size_t l = 0; l <= finest_; ++l)
    terms_[l].aim_at_scattered_mean(grid_.levels[l], sums_[l], samples_.sigma);
}

template <class Real>
void SsdSystem<Real>::aim_at(std::span<const double> targets, std::size_t first) {
  for (std::size_t l = 0; l <= finest_; ++l) terms_[l].aim_at(targets, first);
}

template <class Real>
double SsdSystem<Real>::energy(const Arrays& x) {
  Arrays product = active_arrays<Real>(grid_);
  multiply(x, product, false);  // leaves the sums behind
  double total = 0;
  for (std::size_t l = 0; l <= finest_; ++l) {
    total += terms_[l].energy(grid_.levels[l], sums_[l]);
    total += std::inner_product(x[l].begin(), x[l].end(), product[l].begin(), 0.0);
  }
  return total;
}

template class SsdSystem<float>;
template class SsdSystem<double>;

}  // namespace scan
