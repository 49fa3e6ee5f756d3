// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Many scans along a long path over one surface, with known poses.
#pragma once

#include "libscan/core/parallel.h"
#include "tests/align/simulated_views.h"

namespace scan::test {

// Squares of 2 m, `step_m` apart along x: each meets those less than 2 m away. Noise of an eighth
// of the spacing; the starts are off by 1 degree and 1 cm, as a survey's are.
inline SimulatedViews simulated_path(ScannerNoise kind, std::size_t scans, int side, double step_m,
                                     std::uint64_t seed) {
  const WavySurface surface(seed);
  SimulatedViews path;
  path.clouds.resize(scans);
  for (std::uint32_t i = 0; i < scans; ++i) {
    RandomStream random(seed, 5, i);
    const Pose turned = random_pose(random, 0.5, 1), off = random_pose(random, 0.017, 0.01);
    path.truth.push_back(Eigen::Translation3d(step_m * i, 0, 0) * turned);
    path.guesses.push_back(i == 0 ? path.truth[0] : Pose(path.truth[i] * off));
  }
  parallel_for(
      scans,
      [&](std::size_t i) {
        PointCloud cloud = simulated_scan(surface, kind, 0.25 / side, {step_m * double(i), 0, 0},
                                          side, seed, std::uint32_t(i));
        estimate_normals(cloud, [](const Vector3d&) { return Vector3d::UnitZ(); });
        path.clouds[i] = transformed(path.truth[i].inverse(), cloud);
      },
      1);
  return path;
}

// e^T I e of the motion between an edge's scans, at the poses found, by the edge's own information:
// chi-square with six degrees of freedom if the joint poses err as the pair did.
inline double normalised_link_error2(const MultiviewResult& result, const std::vector<Pose>& truth,
                                     const ScanEdge& edge) {
  const Pose found = result.scans[edge.target].world_from_scan.inverse() *
                     result.scans[edge.source].world_from_scan;
  const Pose should = truth[edge.target].inverse() * truth[edge.source];
  const Pose off = Eigen::Translation3d(-edge.centre) * found * should.inverse() *
                   Eigen::Translation3d(edge.centre);
  const Vector6 twist = log(off);
  return twist.dot(edge.information * twist);
}

// Of the accepted edges between neighbours: how many, and the mean of their errors over the degrees
// of freedom, 1 if the joint poses err as the pairs did.
struct LinkErrors {
  std::size_t links = 0;
  double mean = 0;
};

inline LinkErrors link_errors(const MultiviewResult& result, const std::vector<Pose>& truth) {
  LinkErrors errors;
  double sum = 0;
  for (const ScanEdge& edge : result.edges)
    if (edge.target == edge.source + 1 && edge.accepted && edge.stop == Stop::converged) {
      sum += normalised_link_error2(result, truth, edge) / 6;
      ++errors.links;
    }
  errors.mean = sum / static_cast<double>(errors.links);
  return errors;
}

}  // namespace scan::test
