// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fewer triangles within a distance that is proven afterwards.
#pragma once

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Collapses edges in the order of the squared distances to the planes they stood for (Garland and
// Heckbert 1997), each only if the old vertices and middles of edges that the new triangles stand
// for stay within the tolerance (Klein et al. 1996). Then bounds the Hausdorff distance
// (search/hausdorff.h): a result that is not proven to lie within the tolerance is refused, and the
// work done again with a smaller one inside; if four do not pass, the surface stays as it is.
// Closed and manifold surfaces stay so. What was known of the vertices goes over from the nearest
// old ones. Throws scan::Error (usage) for a tolerance that is not above 0.
DecimateReport decimate(SurfaceResult& result, double tolerance_m);

}  // namespace scan
