// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// CGAL's advancing front (GPL): part of the target libscan::cgal.
#pragma once

#include <span>

#include "libscan/core/mesh.h"

namespace scan {

// Cohen-Steiner and Da 2004. Triangles over the points; vertices are the points themselves, in
// their order, which also decides between edges of one radius.
Mesh advancing_front(std::span<const Eigen::Vector3d> points);

}  // namespace scan
