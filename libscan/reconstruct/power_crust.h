// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The power crust (CGAL, GPL: built with LIBSCAN_WITH_CGAL only).
#pragma once

#include <span>

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Amenta, Choi and Kolluri 2001: where the cells of the large empty balls inside the points meet
// those outside (polar_balls.h). Needs no normals; closed and manifold whatever the points are,
// holes are closed by what lies between the balls. Balls smaller than four times the points'
// scatter (sigma_m, else estimated) are left out. Vertices lie near the points, not on them.
// `spacing_m`: about each point, as prepare_points.h has it. Throws scan::Error: input for fewer
// than 4 finite points or not one spacing for each point, computation if the points enclose
// nothing, usage if libscan was built without CGAL.
SurfaceResult power_crust(const PointCloud& cloud, std::span<const double> spacing_m);

}  // namespace scan
