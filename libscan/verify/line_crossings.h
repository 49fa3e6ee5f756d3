// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Where straight lines cross the surface of an analytic solid.
#pragma once

#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/core/shape.h"

namespace scan {

struct Ball {
  Eigen::Vector3d centre;
  double radius_m;
};
Ball ball_around(const Bounds& box);

struct Line {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  // unit
};

// Adds all crossings from the origin to `length_m` along the line, exact to rounding, with outward
// normals, in the frame that the solid is placed in. Chords shorter than 5e-7 of the length may be
// missed.
void add_crossings(const PlacedShape& solid, const Line& line, double length_m,
                   std::vector<SurfaceSample>& crossings);

}  // namespace scan
