// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// CGAL's Poisson reconstruction (GPL): part of the target libscan::cgal.
#pragma once

#include "libscan/core/mesh.h"

namespace scan {

// Default settings: facets of at least 20 degrees, 0.375 average spacings off the function at most.
// Every point needs a unit normal. An empty mesh if CGAL finds no surface.
Mesh cgal_poisson(const PointCloud& cloud);

}  // namespace scan
