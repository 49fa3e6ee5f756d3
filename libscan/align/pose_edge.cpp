// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pose_edge.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "libscan/core/error.h"

namespace scan {
namespace {

constexpr double open_share = 1e-12;  // of what an edge fixes best; motions below count as open

}  // namespace

void check(std::span<const PoseEdge> edges, std::size_t scans, std::size_t anchor) {
  const auto refuse = [](const std::string& message) {
    throw Error(Trouble::input, "solve_pose_graph: " + message);
  };
  if (anchor >= scans)
    refuse("anchor: " + std::to_string(anchor) + ", must be below " + std::to_string(scans));
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const PoseEdge& edge = edges[i];
    const std::string name = "edge " + std::to_string(i);
    if (std::max(edge.source, edge.target) >= scans || edge.source == edge.target)
      refuse(name + " joins " + std::to_string(edge.source) + " and " +
             std::to_string(edge.target) + ", must be two of " + std::to_string(scans) + " scans");
    if (!edge.target_from_source.matrix().allFinite() || !edge.information.allFinite())
      refuse(name + " is not finite");
  }
}

Matrix6 root_of(const Matrix6& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information);
  Vector6 roots = Vector6::Zero();
  for (int i = 0; i < 6; ++i)
    if (const double value = solver.eigenvalues()[i]; value > open_share * solver.eigenvalues()[5])
      roots[i] = std::sqrt(value);
  return roots.asDiagonal() * solver.eigenvectors().transpose();
}

double chi_square_limit(const Matrix6& information) {
  constexpr std::array<double, 7> quantiles = {0, 10.828, 13.816, 16.266, 18.467, 20.515, 22.458};
  const Matrix6 root = root_of(information);
  std::size_t fixed = 0;
  for (int i = 0; i < 6; ++i) fixed += root.row(i).isZero(0) ? 0 : 1;
  return quantiles[fixed];
}

}  // namespace scan
