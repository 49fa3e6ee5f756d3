// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Combinatorial reconstruction by advancing front (CGAL, GPL: built with LIBSCAN_WITH_CGAL only).
#pragma once

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Cohen-Steiner and Da 2004. Interpolates the points; each component is turned to follow the
// normals where there are any. The mesh need not be closed. Throws scan::Error: input for fewer
// than 4 finite points, computation for an empty result, usage if libscan was built without CGAL.
SurfaceResult delaunay(const PointCloud& cloud);

}  // namespace scan
