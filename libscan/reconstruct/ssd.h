// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Smooth signed distance reconstruction (Calakli and Taubin 2011) on an adaptive octree.
#pragma once

#include "libscan/core/progress.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Weights are dimensionless: the box is scaled to the unit cube and the points to unit total area.
// Where the points are sparse, cells stay wide enough to hold samples_per_cell of them (spacing and
// noise both count, since noise moves neighbours apart), so `depth` is a limit, not a demand.
struct SsdOptions {
  int depth = 8;                    // finest cell = box / 2^depth; 3 to 12
  double samples_per_cell = 1.5;    // cells on the surface with more points split
  double value_weight = 50;         // (f(p))^2
  double gradient_weight = 5e-4;    // |grad f(p) - n|^2
  double smoothness_weight = 1e-5;  // integral of |D^2 f|^2
  double relative_residual = 5e-3;  // of the energy norm, see SsdSolution
  int max_iterations = 2000;
};
void check(const SsdOptions& options);

// The zero level set of f as a closed, oriented, manifold mesh over oriented points (unit normals,
// outward). Where the points leave a surface open it goes on to the walls of the box and along
// them: `support_m` tells how far from data, and trim() cuts it. Components next to less than 0.1 %
// of the data are dropped. Facets are one level finer than the solution if the depth allows it. The
// result depends neither on the order of the points nor on the number of threads.
//
// Points that are not finite or have no normal are left out and counted, so are those far from all
// others. Throws scan::Error: usage for options outside their limits, input for fewer than 16 valid
// points or a cloud without extent, computation if no surface crosses the box, resource if the
// octree would need more than 16 GiB.
SurfaceResult ssd(const PointCloud& cloud, const SsdOptions& options = {},
                  const Progress& progress = {});

}  // namespace scan
