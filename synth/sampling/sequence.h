// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Low-discrepancy numbers addressed by (seed, scan, ray): Owen-scrambled Sobol' points.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace scan::synth {

// The numbers of one ray's paths. Sobol' points in four dimensions with hash-based Owen scrambling,
// each further group of four dimensions an independently scrambled and shuffled copy (Burley 2020,
// "Practical Hash-based Owen Scrambling"). Sequences of different addresses or streams are
// independent, so the spread over streams tells the error of a mean over samples.
class SampleSequence {
 public:
  SampleSequence(std::uint64_t seed, std::uint32_t scan, std::uint64_t ray, std::uint32_t stream);

  // Starts at dimension 0 of the sample with that index, below 2^31.
  void start(std::uint32_t index);
  double next();              // in (0, 1)
  Eigen::Vector2d next_2d();  // of one group of dimensions, its first or its second pair
  Eigen::Vector3d next_3d();  // of one group of dimensions; (y, z) is its best pair, the first

 private:
  std::uint64_t key_ = 0;
  std::uint64_t group_key_ = 0;
  std::uint32_t index_digits_ = 0;  // least significant first
  std::uint32_t shuffled_ = 0;      // index within the group of dimensions
  std::uint32_t dimension_ = 0;
};

}  // namespace scan::synth
