// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far one mesh is from another at most: proven, not sampled.
#pragma once

#include <optional>

#include "libscan/search/closest_point.h"

namespace scan {

// A bound, at most `limit_m`, on the distance of every point of `from` to the mesh of `to`; none if
// there is no such bound. The distance to one triangle is a convex function, so over a triangle it
// is largest at a corner: a triangle of `from` is halved along its sides until each part is that
// near to one triangle. Gives up on parts of 2^-12 of a triangle's size.
std::optional<double> distance_bound(const Mesh& from, const Mesh& to, const MeshSearch& search_to,
                                     double limit_m);

// The larger of both ways; none if either is farther.
std::optional<double> two_sided_bound(const Mesh& a, const Mesh& b, double limit_m);

}  // namespace scan
