// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Several scans of one surface with known poses, each with the noise of a kind of scanner.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "libscan/align/multiview.h"
#include "tests/align/simulated_pairs.h"

namespace scan::test {

struct SimulatedViews {
  std::vector<PointCloud> clouds;
  std::vector<Pose> truth, guesses;  // world_from_scan
};

// Four scans of side x side points at the corners of a square: neighbours share two thirds, those
// across two fifths. Noise of an eighth of the spacing; the starts are off by 1 degree and 1 cm.
inline SimulatedViews simulated_views(ScannerNoise kind, int side, std::uint64_t seed) {
  const WavySurface surface(seed);
  SimulatedViews views;
  for (std::uint32_t i = 0; i < 4; ++i) {
    RandomStream random(seed, 5, i);
    const Vector3d middle(0.7 * (i % 2), 0.7 * (i / 2), 0);
    views.truth.push_back(random_pose(random, 0.5, 1));
    views.guesses.push_back(i == 0 ? views.truth[0]
                                   : Pose(views.truth[i] * random_pose(random, 0.017, 0.01)));
    PointCloud cloud = simulated_scan(surface, kind, 0.25 / side, middle, side, seed, i);
    estimate_normals(cloud, [](const Vector3d&) { return Vector3d::UnitZ(); });
    views.clouds.push_back(transformed(views.truth[i].inverse(), cloud));
  }
  return views;
}

// e^T C^-1 e of a scan's pose against the first one's: chi-square with six degrees of freedom if
// the covariance is right; none if there is no covariance.
inline std::optional<double> normalised_error2(const MultiviewResult& result,
                                               const std::vector<Pose>& truth, std::size_t i) {
  const ScanPose& scan = result.scans[i];
  if (!scan.covariance) return std::nullopt;
  const Pose should = result.scans[0].world_from_scan * truth[0].inverse() * truth[i];
  const Pose off = Eigen::Translation3d(-scan.covariance_centre) * scan.world_from_scan *
                   should.inverse() * Eigen::Translation3d(scan.covariance_centre);
  const Vector6 twist = log(off);
  return twist.dot(scan.covariance->inverse() * twist);
}

}  // namespace scan::test
