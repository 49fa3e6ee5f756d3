// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/sample_term.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/cell_samples.h"
#include "libscan/reconstruct/cell_weights.h"

namespace scan {
namespace {

constexpr std::size_t buckets_per_task = 4;

template <class Real>
SplineWeights<Real> squares(const SplineWeights<Real>& w) {
  SplineWeights<Real> result;
  for (int a = 0; a < 3; ++a) {
    result.value[a] = w.value[a] * w.value[a];
    result.slope[a] = w.slope[a] * w.slope[a];
  }
  return result;
}

// The block's cube to it and its upper neighbours.
template <class Real>
void add_cube(const BlockLevel& level, std::size_t block, const Real* cube,
              std::vector<Real>& sum) {
  for (int dz = 0; dz <= 1; ++dz)
    for (int dy = 0; dy <= 1; ++dy)
      for (int dx = 0; dx <= 1; ++dx) {
        const std::int32_t target = level.neighbours[block][neighbour_slot(dx, dy, dz)];
        if (target < 0) continue;
        Real* to = sum.data() + static_cast<std::size_t>(target) * block_size;
        const Real* from = cube + 4 * (dx + cube_width * (dy + cube_width * dz));
        for (int z = 0; z < (dz > 0 ? 2 : 4); ++z)
          for (int y = 0; y < (dy > 0 ? 2 : 4); ++y)
            for (int x = 0; x < (dx > 0 ? 2 : 4); ++x)
              to[slot_in_block(x, y, z)] += from[x + cube_width * (y + cube_width * z)];
      }
}

}  // namespace

template <class Real>
SampleTerm<Real>::SampleTerm(const BlockLevel& level, const Samples& samples,
                             const SampleWeights& weights, std::span<const std::uint32_t> chosen)
    : cells_(static_cast<Real>(level.cells())) {
  placed_.reserve(chosen.size());
  for (const CellSample& at : in_cells(level, samples, chosen)) {
    const std::uint32_t block = at.cell / block_size;
    if (bucket_block_.empty() || bucket_block_.back() != block) {
      const BlockPlace& p = level.blocks[block];
      const auto bucket = static_cast<std::uint32_t>(bucket_block_.size());
      buckets_of_[static_cast<std::size_t>(p[0] % 2 + 2 * (p[1] % 2) + 4 * (p[2] % 2))].push_back(
          bucket);
      bucket_block_.push_back(block);
      bucket_begin_.push_back(static_cast<std::uint32_t>(placed_.size()));
    }
    const Eigen::Vector3d& u = samples.points[at.sample];
    const BlockPlace cell = cell_at(u, level.cells());
    const Eigen::Vector3d in_cell = u * level.cells() - Eigen::Vector3d(cell[0], cell[1], cell[2]);
    placed_.push_back({in_cell.cast<Real>(), samples.normals[at.sample].template cast<Real>(), 0, 0,
                       0, at.sample, cube_corner(cell)});
  }
  bucket_begin_.push_back(static_cast<std::uint32_t>(placed_.size()));
  set_weights(weights);
}

template <class Real>
void SampleTerm<Real>::set_weights(const SampleWeights& weights) {
  for (Placed& sample : placed_) {
    sample.value_weight = static_cast<Real>(weights.value[sample.sample]);
    sample.gradient_weight = static_cast<Real>(weights.gradient[sample.sample]);
  }
}

template <class Real>
template <class Accumulate>
void SampleTerm<Real>::scatter(const BlockLevel& level, std::vector<Real>& sum,
                               Accumulate&& accumulate_bucket) const {
  for (const std::vector<std::uint32_t>& buckets : buckets_of_)
    parallel_for(
        buckets.size(),
        [&](std::size_t k) {
          Real cube[cube_room] = {};
          accumulate_bucket(buckets[k], cube);
          add_cube(level, bucket_block_[buckets[k]], cube, sum);
        },
        buckets_per_task);
}

template <class Real>
void SampleTerm<Real>::add_product(const BlockLevel& level, const std::vector<Real>& u,
                                   std::vector<Real>& sum) const {
  scatter(level, sum, [&](std::size_t bucket, Real* buffer) {
    Real cube[cube_room];
    cube[cube_size] = 0;
    gather_cell_functions(level, u, bucket_block_[bucket], cube);
    for (const Placed& sample : in_bucket(bucket)) {
      const CellWeights<Real> w = weights_at(sample.in_cell);
      ValueAndSlope<Real> f = evaluate(cube + sample.corner, w);
      f.value *= sample.value_weight;
      f.slope *= sample.gradient_weight * cells_ * cells_;
      accumulate(buffer + sample.corner, w, f);
    }
  });
}

template <class Real>
void SampleTerm<Real>::add_diagonal(const BlockLevel& level, std::vector<Real>& sum) const {
  scatter(level, sum, [&](std::size_t bucket, Real* buffer) {
    for (const Placed& sample : in_bucket(bucket)) {
      // Squares of products are products of squares.
      const CellWeights<Real> w = weights_at(sample.in_cell);
      accumulate<Real>(
          buffer + sample.corner, {squares(w.x), squares(w.y), squares(w.z)},
          {sample.value_weight, Vector::Constant(sample.gradient_weight * cells_ * cells_)});
    }
  });
}

template <class Real>
void SampleTerm<Real>::add_right_side(const BlockLevel& level, std::vector<Real>& sum) const {
  scatter(level, sum, [&](std::size_t bucket, Real* buffer) {
    for (const Placed& sample : in_bucket(bucket))
      accumulate<Real>(buffer + sample.corner, weights_at(sample.in_cell),
                       {sample.value_weight * sample.value_target,
                        sample.gradient_weight * cells_ * sample.normal});
  });
}

template <class Real>
void SampleTerm<Real>::write_residuals(const BlockLevel& level, const std::vector<Real>& u,
                                       std::vector<double>& residuals) const {
  parallel_for(
      bucket_block_.size(),
      [&](std::size_t bucket) {
        Real cube[cube_room];
        cube[cube_size] = 0;
        gather_cell_functions(level, u, bucket_block_[bucket], cube);
        for (const Placed& sample : in_bucket(bucket)) {
          const ValueAndSlope<Real> f = evaluate(cube + sample.corner, weights_at(sample.in_cell));
          const double slope = cells_ * f.slope.norm();
          residuals[sample.sample] = slope > 0 ? f.value / slope : 0;
        }
      },
      buckets_per_task);
}

template <class Real>
void SampleTerm<Real>::aim_at_scattered_mean(const BlockLevel& level, const std::vector<Real>& u,
                                             std::span<const double> sigma) {
  parallel_for(
      bucket_block_.size(),
      [&](std::size_t bucket) {
        Real cube[cube_room];
        gather_cell_functions(level, u, bucket_block_[bucket], cube);
        for (std::uint32_t i = bucket_begin_[bucket]; i < bucket_begin_[bucket + 1]; ++i) {
          Placed& sample = placed_[i];
          const double scale = sigma[sample.sample] * cells_;
          sample.value_target = static_cast<Real>(
              0.5 * scale * scale * laplacian(cube + sample.corner, weights_at(sample.in_cell)));
        }
      },
      buckets_per_task);
}

template <class Real>
void SampleTerm<Real>::aim_at(std::span<const double> targets, std::size_t first) {
  for (Placed& sample : placed_)
    if (sample.sample >= first)
      sample.value_target = static_cast<Real>(targets[sample.sample - first]);
}

template <class Real>
double SampleTerm<Real>::energy(const BlockLevel& level, const std::vector<Real>& u) const {
  double total = 0;
  Real cube[cube_room];
  cube[cube_size] = 0;
  for (std::size_t bucket = 0; bucket < bucket_block_.size(); ++bucket) {
    gather_cell_functions(level, u, bucket_block_[bucket], cube);
    for (const Placed& sample : in_bucket(bucket)) {
      const ValueAndSlope<Real> f = evaluate(cube + sample.corner, weights_at(sample.in_cell));
      const double value = f.value - sample.value_target;
      total += sample.value_weight * value * value +
               sample.gradient_weight * (cells_ * f.slope - sample.normal).squaredNorm();
    }
  }
  return total;
}

template class SampleTerm<float>;
template class SampleTerm<double>;

}  // namespace scan
