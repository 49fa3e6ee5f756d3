// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// One level of a sum of compactly supported radial functions: its nodes, its fit, its value.
#pragma once

#include <cstdint>
#include <vector>

#include "libscan/reconstruct/wendland.h"

namespace scan {

struct RbfNode {
  Eigen::Vector3d place;
  Jet wanted;               // value, and gradient times the radius
  double variance = 0;      // of the wanted value
  double slack = 0;         // mean square by which the level may miss it, though it is no noise
  std::uint32_t group = 0;  // the caller's number for it
};

struct RbfSolve {
  int iterations = 0;
  double relative_residual = 0;  // |(K + R) c - wanted| / |wanted|
};

// f(x) = sum_j c_j . (phi, -grad phi)((x - x_j) / radius): Hermite interpolation (Wu 1992), 4
// unknowns a node, sparse.
class RbfLevel {
 public:
  // Nodes in any order; the level keeps them in the order of cells as wide as the radius.
  RbfLevel(double radius, std::vector<RbfNode> nodes);

  // Solves (K + R) c = wanted by conjugate gradients. R is each node's variance and slack over
  // the signal's variance, which is how much the squares of the values wanted around it exceed
  // their own variances (the method of moments), by more than two standard errors: where there is
  // nothing but noise, the level keeps to 0. Normals count as no more certain than a plane fitted
  // one node spacing wide.
  RbfSolve solve(double node_spacing, double relative_residual, int max_iterations);

  // At x: value and gradient (not times the radius).
  Jet at(const Eigen::Vector3d& x) const;
  double value(const Eigen::Vector3d& x) const;

  const std::vector<RbfNode>& nodes() const { return nodes_; }
  // After solve(): whether a node has nothing to say but noise.
  bool is_silent(std::size_t node) const { return silent_[node]; }

 private:
  static constexpr double most_ridge = 1e6;

  template <class Visit>
  void for_nodes_about(const Eigen::Vector3d& x, Visit&& visit) const;
  void find_neighbours();
  std::vector<double> mean_about(const std::vector<double>& values, bool trimmed) const;
  void find_ridges();
  std::vector<Jet> multiply(const std::vector<Jet>& c) const;

  double radius_;
  std::vector<RbfNode> nodes_;
  std::vector<Jet> shares_;
  std::vector<double> ridge_;
  std::vector<char> silent_;
  std::vector<std::uint64_t> cells_;  // that hold nodes, ascending
  std::vector<std::uint32_t> first_;  // node of each cell, and the end
  std::vector<std::size_t> first_neighbour_;
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace scan
