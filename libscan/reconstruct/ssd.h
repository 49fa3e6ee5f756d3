// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Smooth signed distance reconstruction (Calakli and Taubin 2011) on an adaptive octree.
#pragma once

#include "libscan/core/progress.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

// What is 0 is chosen from the points.
struct SsdOptions {
  int depth = 12;                 // most: cells are not narrower than box / 2^depth; 3 to 12
  double sigma_m = 0;             // scatter of points that do not carry their own
  double smoothing_length_m = 0;  // least; ripples of 2 pi times this length are halved
  double relative_residual = 0;   // of the energy norm, see SsdSolution
  int max_iterations = 2000;      // of a part
  double memory_gib = 16;         // most; what needs more is solved in parts (ssd_parts.h)
};
void check(const SsdOptions& options);

// The zero level set of f as a closed, oriented, manifold mesh over oriented points (unit normals,
// outward). Where the points leave a surface open it goes on to the walls of the box and along
// them: `support_m` tells how far from data, and trim() cuts it. Where they leave open less than a
// third, no surface goes far on the wrong side of it (far_places.h; not in parts). Components next
// to less than 0.1 % of the data are dropped. Facets are one level finer than the solution if the
// depth allows it. The result depends neither on the order of the points nor on the number of
// threads.
//
// Points that are not finite or have no normal are left out and counted, so are those far from all
// others. Throws scan::Error: usage for options outside their limits, input for fewer than 16 valid
// points or a cloud without extent, computation if no surface crosses the box, resource if even
// parts would need more memory than allowed: before any of it is taken.
SurfaceResult ssd(const PointCloud& cloud, const SsdOptions& options = {},
                  const Progress& progress = {});

// Likewise, and then afresh through points moved up to creases (bilateral_samples.h): they replace
// the cloud and `spacing_m`. Standard errors and smoothing lengths stay those of the first fit.
// Where no points are moved, and in parts, all is as ssd() has it.
SurfaceResult ssd_up_to_creases(PointCloud& cloud, std::vector<double>& spacing_m,
                                const SsdOptions& options = {}, const Progress& progress = {});

}  // namespace scan
