// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Least-squares (Gauss) fits of sphere, plane, cylinder, cone and torus, as artefact tests use
// them.
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
  Eigen::Vector3d point_m;  // the centroid
  Eigen::Vector3d normal;   // unit
  double rms_m = 0;
};

// A line in space.
struct Axis {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit
};
struct CylinderFit {
  Axis axis;  // its point is the one nearest to the points' centroid
  double radius_m = 0;
  double rms_m = 0;
};
// The radius is that at the axis' point, which is nearest to the points' centroid; it grows along
// the direction by tan(half_angle), which is not negative.
struct ConeFit {
  Axis axis;
  double half_angle_rad = 0;
  double radius_m = 0;
  double rms_m = 0;
};
struct TorusFit {
  Axis axis;  // its point is the centre
  double major_radius_m = 0;
  double minor_radius_m = 0;
  double rms_m = 0;
};

// Orthogonal-distance fits: they minimise the sum of the squared distances of the points to the
// surface, to 1e-9 of the size far from the origin and on partial arcs (ISO 10360-6 asks it of
// fitting software). The fits of surfaces of revolution start at a guess of the axis (a nominal
// one; its direction need not be a unit vector) and find the nearest minimum. Throw scan::Error
// (computation) for fewer points than the surface has parameters (sphere 4, plane 3, cylinder 5,
// cone 6, torus 7), points that do not determine the shape, and a guess from which no minimum is
// found.
SphereFit fit_sphere(std::span<const Eigen::Vector3d> points);
PlaneFit fit_plane(std::span<const Eigen::Vector3d> points);
CylinderFit fit_cylinder(std::span<const Eigen::Vector3d> points, const Axis& guess);
ConeFit fit_cone(std::span<const Eigen::Vector3d> points, const Axis& guess);
TorusFit fit_torus(std::span<const Eigen::Vector3d> points, const Axis& guess);

}  // namespace scan
