// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fusion of rays: what is before a measured point is free, what is behind it is not known.
#pragma once

#include <span>

#include "libscan/core/progress.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

struct RangeFusionOptions {
  double cell_spacings = 1;        // least side of a cell over the typical spacing of samples
  double truncation_spacings = 3;  // reach of a point along its ray, at least
  double truncation_sigmas = 4;    // and over its sigma_m, where that is known
  int max_depth = 11;              // the finest cell is the box / 2^depth
};
void check(const RangeFusionOptions& options);

// Truncated signed distances (Curless and Levoy 1996): each point speaks of places on and beside
// its ray within its truncation, weighted by the cosine of incidence, 1 / sigma^2 and how far it
// faces as the point nearest to the place does, so that corners and thin walls stay. The distance
// is that from between the tangent planes there and here. Rays that come out behind a surface say
// that it is not there, so that scanners see through strays. Where nothing is known the surface
// ends. Points need unit normals and the place of their scanner; one that is not finite leaves its
// point out. Throws scan::Error: usage for options outside their limits, input for missing
// viewpoints, fewer than 16 valid points or a cloud without extent, computation for an empty
// surface.
SurfaceResult range_fusion(const PointCloud& cloud, std::span<const Eigen::Vector3d> viewpoints,
                           const RangeFusionOptions& options = {}, const Progress& progress = {});

}  // namespace scan
