// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The samples' part of the energy on one level: sum of v (f - f0)^2 + g |grad f - n|^2.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "libscan/reconstruct/samples.h"
#include "libscan/reconstruct/spline_levels.h"

namespace scan {

// Per sample of the cloud.
struct SampleWeights {
  std::vector<double> value;
  std::vector<double> gradient;
};

// For float and double. Samples are kept by the block of their cell. A block's sums reach it and
// its upper neighbours; blocks whose places are even or odd alike on all axes share none, and such
// groups take turns: nothing depends on the order of threads.
template <class Real>
class SampleTerm {
 public:
  SampleTerm() = default;
  // `chosen`: indices of the samples on this level. They aim at f0 = 0.
  SampleTerm(const BlockLevel& level, const Samples& samples, const SampleWeights& weights,
             std::span<const std::uint32_t> chosen);
  void set_weights(const SampleWeights& weights);

  // sum += (matrix of the term) u, on all blocks; `u` holds all blocks.
  void add_product(const BlockLevel& level, const std::vector<Real>& u,
                   std::vector<Real>& sum) const;
  // sum += diagonal of that matrix.
  void add_diagonal(const BlockLevel& level, std::vector<Real>& sum) const;
  // sum += v f0 B + g n . grad B.
  void add_right_side(const BlockLevel& level, std::vector<Real>& sum) const;
  // Of each sample on this level: f / |grad f|.
  void write_residuals(const BlockLevel& level, const std::vector<Real>& u,
                       std::vector<double>& residuals) const;
  // Aims at f = sigma^2 / 2 times the Laplacian of u at each sample.
  void aim_at_scattered_mean(const BlockLevel& level, const std::vector<Real>& u,
                             std::span<const double> sigma);
  // Aims at f = targets[k] at sample `first` + k.
  void aim_at(std::span<const double> targets, std::size_t first);
  // The term's own value for u.
  double energy(const BlockLevel& level, const std::vector<Real>& u) const;

 private:
  using Vector = Eigen::Matrix<Real, 3, 1>;
  struct Placed {
    Vector in_cell;  // coordinates in the cell, [0, 1]
    Vector normal;
    Real value_target;
    Real value_weight, gradient_weight;
    std::uint32_t sample;
    int corner;  // of the cell's functions in the block's cube
  };
  std::span<const Placed> in_bucket(std::size_t bucket) const {
    return std::span(placed_).subspan(bucket_begin_[bucket],
                                      bucket_begin_[bucket + 1] - bucket_begin_[bucket]);
  }
  template <class Accumulate>
  void scatter(const BlockLevel& level, std::vector<Real>& sum, Accumulate&& accumulate) const;

  Real cells_ = 0;
  std::vector<std::uint32_t> bucket_block_;               // per bucket: its block
  std::vector<std::uint32_t> bucket_begin_;               // per bucket, and the end
  std::array<std::vector<std::uint32_t>, 8> buckets_of_;  // by evenness along the axes
  std::vector<Placed> placed_;
};

}  // namespace scan
