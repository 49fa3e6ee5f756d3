// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// CGAL's scale space reconstruction (GPL): part of the target libscan::cgal.
#pragma once

#include <span>

#include "libscan/core/mesh.h"

namespace scan {

// Triangles over the points, found by an advancing front on a copy that `smoothings` fits of planes
// have smoothed. Vertices are the points themselves, in their order.
Mesh cgal_scale_space(std::span<const Eigen::Vector3d> points, int smoothings);

}  // namespace scan
