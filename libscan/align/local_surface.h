// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the neighbours of each point say of the surface there, and how far that can be believed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libscan/search/search.h"

namespace scan {

enum class LocalShape : std::uint8_t { unknown, line, surface, volume };

struct LocalFit {
  // Of the line, or unit normal of the surface (up to sign); zero for the other shapes.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  // A draw of the normal's error: half the difference of the normals that two halves of the
  // neighbours give, whose noise is independent; the fit to both errs by as much.
  Eigen::Vector3f tilt = Eigen::Vector3f::Zero();
  // Of the nearest other point from the surface.
  float neighbour_off_m = 0;
  // Distance to the farthest neighbour: beyond it the fit says nothing.
  float reach_m = 0;
  LocalShape shape = LocalShape::unknown;
};

// One per point. Fits over each point and the nearest to it, `neighbours` together (at least 6);
// where these fix no shape, repeated points being one, or lie on a line, over four
// times as many. `search` is over `points`, which are finite.
std::vector<LocalFit> local_fits(std::span<const Eigen::Vector3d> points, const AnySearch& search,
                                 std::size_t neighbours);
std::vector<LocalFit> local_fits(std::span<const Eigen::Vector3d> points, const KdTree& search,
                                 std::size_t neighbours);

// Median distance to the nearest other point, metres; 0 for fewer than two. From up to 512 points.
double spacing_m(std::span<const Eigen::Vector3d> points, const AnySearch& search);
double spacing_m(std::span<const Eigen::Vector3d> points, const KdTree& search);

}  // namespace scan
