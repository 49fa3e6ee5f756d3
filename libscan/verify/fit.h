// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Least-squares (Gauss) fits of sphere and plane, as artefact tests use them.
#pragma once

#include <span>

#include <Eigen/Core>

namespace scan {

struct SphereFit {
  Eigen::Vector3d centre_m;
  double radius_m = 0;
  double rms_m = 0;
};
struct PlaneFit {
  Eigen::Vector3d point_m;   // the centroid
  Eigen::Vector3d normal;    // unit
  double rms_m = 0;
};

// Orthogonal-distance fits, accurate to 1e-9 of size far from the origin. Throw scan::Error
// (computation) for fewer than 4 (3) points or points that do not determine the shape.
SphereFit fit_sphere(std::span<const Eigen::Vector3d> points);
PlaneFit fit_plane(std::span<const Eigen::Vector3d> points);

}  // namespace scan
