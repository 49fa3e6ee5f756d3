// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Radial basis functions of compact support, from wide ones to narrow ones.
#pragma once

#include "libscan/core/progress.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

struct RbfOptions {
  int max_depth = 11;  // the finest cell is the box / 2^depth
};
void check(const RbfOptions& options);

// A sphere fitted to all points, then level by level (Floater and Iske 1996; Ohtake et al. 2003)
// what is still missing of value 0 and gradient = normal, averaged over cubes of a third of the
// level's radius, as Hermite data (rbf_level.h); the radius halves from the box to the spacing.
// Samples that lie too far apart for a level have no say in it. The wide levels also learn how far
// off the samples places away from them are, and on which side (winding_number.h); else the sum
// would vanish anywhere. Where the points scatter, a level is held back by as much as its data are
// noise. The function is known everywhere: holes are closed, and `support_m` tells how far from
// data. Points need unit normals, outward. Throws scan::Error: usage for options outside their
// limits, input for fewer than 16 valid points or a cloud without extent, computation for an empty
// surface.
SurfaceResult rbf(const PointCloud& cloud, const RbfOptions& options = {},
                  const Progress& progress = {});

}  // namespace scan
