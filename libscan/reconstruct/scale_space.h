// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Scale space reconstruction (CGAL, GPL: built with LIBSCAN_WITH_CGAL only).
#pragma once

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Digne et al. 2011: interpolates the points, joined as an advancing front joins their smoothed
// copies, so that noise does not decide who is whose neighbour. Each component is turned to follow
// the normals where there are any. The mesh need not be closed. Throws scan::Error: input for fewer
// than 4 finite points, computation for an empty result, usage if libscan was built without CGAL.
SurfaceResult scale_space(const PointCloud& cloud);

}  // namespace scan
