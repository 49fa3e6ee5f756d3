// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/sample_term.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/cell_weights.h"

namespace scan {
namespace {

constexpr std::size_t buckets_per_task = 4;

SplineWeights squares(const SplineWeights& w) {
  SplineWeights result;
  for (int a = 0; a < 3; ++a) {
    result.value[a] = w.value[a] * w.value[a];
    result.slope[a] = w.slope[a] * w.slope[a];
  }
  return result;
}

}  // namespace

SampleTerm::SampleTerm(const BlockLevel& level, const Samples& samples,
                       const SampleWeights& weights, std::span<const std::uint32_t> chosen)
    : cells_(level.cells()) {
  struct Address {
    std::uint32_t block, cell, sample;
    bool operator<(const Address& other) const {
      return std::tie(block, cell, sample) < std::tie(other.block, other.cell, other.sample);
    }
  };
  std::vector<Address> addresses(chosen.size());
  parallel_for(chosen.size(), [&](std::size_t i) {
    const BlockPlace cell = cell_at(samples.points[chosen[i]], level.cells());
    const std::int32_t block = level.find({cell[0] / 4, cell[1] / 4, cell[2] / 4});
    addresses[i] = {
        static_cast<std::uint32_t>(block),
        static_cast<std::uint32_t>(slot_in_block(cell[0] % 4, cell[1] % 4, cell[2] % 4)),
        chosen[i]};
  });
  std::sort(addresses.begin(), addresses.end());
  bucket_of_block_.assign(level.blocks.size(), -1);
  placed_.reserve(addresses.size());
  for (const Address& at : addresses) {
    if (bucket_block_.empty() || bucket_block_.back() != at.block) {
      bucket_of_block_[at.block] = static_cast<std::int32_t>(bucket_block_.size());
      bucket_block_.push_back(at.block);
      bucket_begin_.push_back(static_cast<std::uint32_t>(placed_.size()));
    }
    const Eigen::Vector3d& u = samples.points[at.sample];
    const Eigen::Vector3d& normal = samples.normals[at.sample];
    const BlockPlace cell = cell_at(u, level.cells());
    placed_.push_back({u * cells_ - Eigen::Vector3d(cell[0], cell[1], cell[2]), normal, 0, 0, 0,
                       at.sample, cube_corner(cell)});
  }
  bucket_begin_.push_back(static_cast<std::uint32_t>(placed_.size()));
  set_weights(weights);
}

void SampleTerm::set_weights(const SampleWeights& weights) {
  for (Placed& sample : placed_) {
    sample.value_weight = weights.value[sample.sample];
    sample.gradient_weight = weights.gradient[sample.sample];
  }
}

template <class Accumulate>
void SampleTerm::scatter(const BlockLevel& level, std::vector<double>& sum,
                         Accumulate&& accumulate_bucket) const {
  const std::size_t buckets = bucket_block_.size();
  if (buckets == 0) return;
  std::vector<double> buffers(buckets * cube_size, 0.0);
  parallel_for(
      buckets, [&](std::size_t k) { accumulate_bucket(k, buffers.data() + k * cube_size); },
      buckets_per_task);
  parallel_for(level.blocks.size(), [&](std::size_t block) {
    double* to = sum.data() + block * block_size;
    // Cells of this block and of the lower neighbours reach its functions.
    for (int dz = -1; dz <= 0; ++dz)
      for (int dy = -1; dy <= 0; ++dy)
        for (int dx = -1; dx <= 0; ++dx) {
          const std::int32_t from = level.neighbours[block][neighbour_slot(dx, dy, dz)];
          if (from < 0 || bucket_of_block_[from] < 0) continue;
          const double* cube =
              buffers.data() + static_cast<std::size_t>(bucket_of_block_[from]) * cube_size;
          for (int z = 0; z < (dz < 0 ? 2 : 4); ++z)
            for (int y = 0; y < (dy < 0 ? 2 : 4); ++y)
              for (int x = 0; x < (dx < 0 ? 2 : 4); ++x)
                to[slot_in_block(x, y, z)] +=
                    cube[x - 4 * dx + cube_width * (y - 4 * dy + cube_width * (z - 4 * dz))];
        }
  });
}

void SampleTerm::add_product(const BlockLevel& level, const std::vector<double>& u,
                             std::vector<double>& sum) const {
  scatter(level, sum, [&](std::size_t bucket, double* buffer) {
    double cube[cube_size];
    gather_cell_functions(level, u, bucket_block_[bucket], cube);
    for (std::uint32_t i = bucket_begin_[bucket]; i < bucket_begin_[bucket + 1]; ++i) {
      const Placed& sample = placed_[i];
      const CellWeights w = weights_at(sample.in_cell);
      ValueAndSlope f = evaluate(cube + sample.corner, w);
      f.value *= sample.value_weight;
      f.slope *= sample.gradient_weight * cells_ * cells_;
      accumulate(buffer + sample.corner, w, f);
    }
  });
}

void SampleTerm::add_diagonal(const BlockLevel& level, std::vector<double>& sum) const {
  scatter(level, sum, [&](std::size_t bucket, double* buffer) {
    for (std::uint32_t i = bucket_begin_[bucket]; i < bucket_begin_[bucket + 1]; ++i) {
      const Placed& sample = placed_[i];
      // Squares of products are products of squares.
      const CellWeights w = weights_at(sample.in_cell);
      accumulate(buffer + sample.corner, {squares(w.x), squares(w.y), squares(w.z)},
                 {sample.value_weight,
                  Eigen::Vector3d::Constant(sample.gradient_weight * cells_ * cells_)});
    }
  });
}

void SampleTerm::add_right_side(const BlockLevel& level, std::vector<double>& sum) const {
  scatter(level, sum, [&](std::size_t bucket, double* buffer) {
    for (std::uint32_t i = bucket_begin_[bucket]; i < bucket_begin_[bucket + 1]; ++i) {
      const Placed& sample = placed_[i];
      accumulate(buffer + sample.corner, weights_at(sample.in_cell),
                 {sample.value_weight * sample.value_target,
                  sample.gradient_weight * cells_ * sample.normal});
    }
  });
}

void SampleTerm::write_residuals(const BlockLevel& level, const std::vector<double>& u,
                                 std::vector<double>& residuals) const {
  parallel_for(
      bucket_block_.size(),
      [&](std::size_t bucket) {
        double cube[cube_size];
        gather_cell_functions(level, u, bucket_block_[bucket], cube);
        for (std::uint32_t i = bucket_begin_[bucket]; i < bucket_begin_[bucket + 1]; ++i) {
          const ValueAndSlope f =
              evaluate(cube + placed_[i].corner, weights_at(placed_[i].in_cell));
          const double slope = cells_ * f.slope.norm();
          residuals[placed_[i].sample] = slope > 0 ? f.value / slope : 0;
        }
      },
      buckets_per_task);
}

void SampleTerm::aim_at_scattered_mean(const BlockLevel& level, const std::vector<double>& u,
                                       std::span<const double> sigma) {
  parallel_for(
      bucket_block_.size(),
      [&](std::size_t bucket) {
        double cube[cube_size];
        gather_cell_functions(level, u, bucket_block_[bucket], cube);
        for (std::uint32_t i = bucket_begin_[bucket]; i < bucket_begin_[bucket + 1]; ++i) {
          Placed& sample = placed_[i];
          const double scale = sigma[sample.sample] * cells_;
          sample.value_target =
              0.5 * scale * scale * laplacian(cube + sample.corner, weights_at(sample.in_cell));
        }
      },
      buckets_per_task);
}

double SampleTerm::energy(const BlockLevel& level, const std::vector<double>& u) const {
  double total = 0;
  double cube[cube_size];
  for (std::size_t bucket = 0; bucket < bucket_block_.size(); ++bucket) {
    gather_cell_functions(level, u, bucket_block_[bucket], cube);
    for (std::uint32_t i = bucket_begin_[bucket]; i < bucket_begin_[bucket + 1]; ++i) {
      const Placed& sample = placed_[i];
      const ValueAndSlope f = evaluate(cube + sample.corner, weights_at(sample.in_cell));
      const double value = f.value - sample.value_target;
      total += sample.value_weight * value * value +
               sample.gradient_weight * (cells_ * f.slope - sample.normal).squaredNorm();
    }
  }
  return total;
}

}  // namespace scan
