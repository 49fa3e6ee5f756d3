// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Which correspondences can be right together: a rigid motion keeps distances and the angle
// between normals. A graph as rows of bits.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace scan {

// A source point and where the target may show it; normals unit, or zero: unknown.
struct Correspondence {
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d source_normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_normal = Eigen::Vector3d::Zero();
};

// An undirected graph without loops.
class BitGraph {
 public:
  explicit BitGraph(std::size_t size);
  std::size_t size() const { return size_; }
  std::size_t words() const { return words_; }
  std::span<const std::uint64_t> row(std::size_t i) const { return {&bits_[i * words_], words_}; }
  std::span<std::uint64_t> row(std::size_t i) { return {&bits_[i * words_], words_}; }
  bool has(std::size_t i, std::size_t j) const { return row(i)[j / 64] >> (j % 64) & 1; }
  void join(std::size_t i, std::size_t j);
  std::size_t degree(std::size_t i) const;

 private:
  std::size_t size_, words_;
  std::vector<std::uint64_t> bits_;
};

// Calls use(index) for each set bit in rising order.
template <class Use>
void for_each_bit(std::span<const std::uint64_t> bits, Use&& use) {
  for (std::size_t word = 0; word < bits.size(); ++word)
    for (std::uint64_t rest = bits[word]; rest != 0; rest &= rest - 1)
      use(64 * word + static_cast<std::size_t>(std::countr_zero(rest)));
}

struct CompatibilityLimits {
  double distance_m = 0;        // by which two distances that should be equal may differ
  double least_distance_m = 0;  // nearer pairs say too little
  double cosine = 2;            // by which two cosines between normals may differ; 2: all agree
};

BitGraph compatibility(std::span<const Correspondence> correspondences,
                       const CompatibilityLimits& limits);

}  // namespace scan
