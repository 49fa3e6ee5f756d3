// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The samples' part of the energy on one level: sum of v (f - f0)^2 + g |grad f - n|^2.
#pragma once

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

// Samples are kept by the block of their cell; each block's sums go to a buffer of its own, and the
// blocks around fetch them from there, so nothing depends on the order of threads.
class SampleTerm {
 public:
  SampleTerm() = default;
  // `chosen`: indices of the samples on this level. They aim at f0 = 0.
  SampleTerm(const BlockLevel& level, const Samples& samples, const SampleWeights& weights,
             std::span<const std::uint32_t> chosen);
  void set_weights(const SampleWeights& weights);

  // sum += (matrix of the term) u, on all blocks; `u` holds all blocks.
  void add_product(const BlockLevel& level, const std::vector<double>& u,
                   std::vector<double>& sum) const;
  // sum += diagonal of that matrix.
  void add_diagonal(const BlockLevel& level, std::vector<double>& sum) const;
  // sum += v f0 B + g n . grad B.
  void add_right_side(const BlockLevel& level, std::vector<double>& sum) const;
  // Of each sample on this level: f / |grad f|.
  void write_residuals(const BlockLevel& level, const std::vector<double>& u,
                       std::vector<double>& residuals) const;
  // Aims at f = sigma^2 / 2 times the Laplacian of u at each sample.
  void aim_at_scattered_mean(const BlockLevel& level, const std::vector<double>& u,
                             std::span<const double> sigma);
  // The term's own value for u.
  double energy(const BlockLevel& level, const std::vector<double>& u) const;

 private:
  struct Placed {
    Eigen::Vector3d in_cell;  // coordinates in the cell, [0, 1]
    Eigen::Vector3d normal;
    double value_target;
    double value_weight, gradient_weight;
    std::uint32_t sample;
    int corner;  // of the cell's functions in the block's cube
  };
  template <class Accumulate>
  void scatter(const BlockLevel& level, std::vector<double>& sum, Accumulate&& accumulate) const;

  double cells_ = 0;
  std::vector<std::uint32_t> bucket_block_;  // per bucket: its block
  std::vector<std::uint32_t> bucket_begin_;  // per bucket, and the end
  std::vector<std::int32_t> bucket_of_block_;
  std::vector<Placed> placed_;
};

}  // namespace scan
