// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Cutting away surface that no data supports.
#pragma once

#include "libscan/reconstruct/surface_result.h"

namespace scan {

struct TrimReport {
  double removed_area_m2 = 0;
  std::size_t removed_triangles = 0;
};

// Removes triangles with a vertex whose support is farther than max_support_m, then unused vertices
// and components smaller than min_component_fraction of the area.
TrimReport trim(SurfaceResult& result, double max_support_m, double min_component_fraction = 1e-3);

}  // namespace scan
