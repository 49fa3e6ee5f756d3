// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The large empty balls that touch points of a surface: its inside and its outside are their union.
#pragma once

#include <span>
#include <vector>

#include "libscan/reconstruct/power_diagram.h"

namespace scan {

// Two balls and how surely they lie on the same side of the surface, or on different sides; 0: they
// meet without saying.
struct PolarTie {
  std::uint32_t first = 0, second = 0;
  double certainty = 0;  // at most 1
  bool is_same_side = true;
};

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

// How surely two balls lie on the same side: the cosine of the angle between their radii where
// their spheres meet, 0 at least. Balls of two sides of a surface meet at its points only.
double same_side_certainty(const Ball& a, const Ball& b);

// Whether each ball lies inside, from the outer ones on, the surest next (ibid., section 3.3).
// Balls that no tie reaches lie beyond a layer of points that scatter: on the other side than those
// that they meet.
std::vector<char> label_inside(std::size_t balls, std::span<const PolarTie> ties,
                               std::span<const char> is_outer);

}  // namespace scan
