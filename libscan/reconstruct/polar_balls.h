// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The large empty balls that touch points of a surface: its inside and its outside are their union.
#pragma once

#include <span>
#include <vector>

#include "libscan/reconstruct/polar_labels.h"
#include "libscan/reconstruct/power_diagram.h"

namespace scan {

struct PolarBalls {
  std::vector<Ball> balls;
  std::vector<Eigen::Vector3d> touched;  // by ball: one of the points on it
  std::vector<PolarTie> opposites;       // the two balls of a point, by their angle
  std::vector<char> is_outer;            // touches the frame around all points
};

// Amenta, Choi and Kolluri, "The power crust" (2001): of each point's Voronoi cell the corner
// farthest from it, and the farthest of those on its other side. Eight corners of a frame, five
// times as large as the points' box, bound the cells. A ball that is smaller than `least_radius`
// lies among the points' scatter and is left out, after Dey and Goswami, "Provable surface
// reconstruction from noisy samples" (2006).
PolarBalls polar_balls(std::span<const Eigen::Vector3d> points, std::span<const double> spacing,
                       double least_radius);

}  // namespace scan
