// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Combinatorial reconstruction by advancing front (CGAL, GPL: built with LIBSCAN_WITH_CGAL only).
#pragma once

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Cohen-Steiner and Da 2004. Interpolates the points; triangles follow the normals where there are any.
// Throws scan::Error: input for fewer than 4 points, computation for an empty result, usage if libscan
// was built without CGAL.
SurfaceResult delaunay(const PointCloud& cloud);

}  // namespace scan
