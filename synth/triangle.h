// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Ray against triangle in double precision, without leaks between neighbours.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace scan::synth {

// A ray's shear to its largest axis (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle
// Intersection"): set up once, used for many triangles.
struct ShearedRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d shear;  // of x, of y, scale of z
  std::array<int, 3> axis;
};
ShearedRay sheared(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

// Distance along the unit direction to the triangle abc, of either sign; none if the line passes it
// by or the triangle is seen edge-on. Points on an edge belong to both of its triangles: the test
// of a shared edge gives the same numbers with opposite signs.
std::optional<double> line_distance(const ShearedRay& ray, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace scan::synth
