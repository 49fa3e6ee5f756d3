// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Rings of scans and measured edges between them, right and wrong ones.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <vector>

#include "libscan/align/pose_graph.h"
#include "libscan/core/random.h"

namespace scan {

// Scanners around the origin at 2 m, looking at it.
inline std::vector<Pose> ring(std::size_t count) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    poses.push_back(look_at({2 * std::cos(angle), 2 * std::sin(angle), 0.3}, {0, 0, 0},
                            Eigen::Vector3d::UnitZ()));
  }
  return poses;
}

inline Vector6 random_vector(RandomStream& random) {
  Vector6 v;
  for (int i = 0; i < 6; ++i) v[i] = random.normal();
  return v;
}

// The true relative pose, off by a draw of the information's own covariance.
inline PoseEdge measured_edge(const std::vector<Pose>& truth, std::size_t source,
                              std::size_t target, const Matrix6& information,
                              RandomStream& random) {
  const Vector6 error = information.llt().matrixU().solve(random_vector(random));
  return {source, target, exp(error) * truth[target].inverse() * truth[source], information};
}

// Off by a turn of 20 degrees or more, and by some 0.3 m.
inline PoseEdge wrong_edge(const std::vector<Pose>& truth, std::size_t source, std::size_t target,
                           const Matrix6& information, RandomStream& random) {
  Vector6 error = random_vector(random);
  const double turn_rad = 0.35 + 2.5 * random.uniform();
  error.head<3>() *= turn_rad / error.head<3>().norm();
  error.tail<3>() *= 0.2;
  return {source, target, exp(error) * truth[target].inverse() * truth[source], information};
}

// 0.1 degrees and 1 mm, each direction by itself.
inline Matrix6 usual_information() {
  Vector6 diagonal;
  diagonal << 3.3e5, 3.3e5, 3.3e5, 1e6, 1e6, 1e6;
  return diagonal.asDiagonal();
}

}  // namespace scan
