// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Poisson reconstruction (CGAL, GPL: built with LIBSCAN_WITH_CGAL only).
#pragma once

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Kazhdan et al. 2006 on a Delaunay refinement of the points. Every point needs a unit normal.
// Throws scan::Error: input for fewer than 4 points with a normal, computation for an empty result,
// usage if libscan was built without CGAL.
SurfaceResult poisson(const PointCloud& cloud);

}  // namespace scan
