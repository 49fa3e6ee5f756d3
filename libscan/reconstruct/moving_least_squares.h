// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Robust moving least squares: a sphere fitted about every place, its distance the function.
#pragma once

#include "libscan/core/progress.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

struct MlsOptions {
  double support_spacings = 0;    // radius of support over the local sample spacing; 0: chosen
  double normal_tolerance = 0.8;  // points whose normal differs by this length lose weight by 1/e
  int max_depth = 11;             // the finest cell is the box / 2^depth or a third of the support
};
void check(const MlsOptions& options);

// Algebraic point set surface (Guennebaud and Gross 2007) with the robust normal weights of
// Oztireli et al. 2009: exact on planes and spheres, smooth within the support, sharp where normals
// part. The support is the one of 2.5 to 20 spacings whose surface passes nearest to samples that
// are left out with their neighbours. Points need unit normals, outward. Where the samples end the
// surface ends. So does a sheet that starts in a slit or at an edge as narrow as the scatter, where
// fits disagree which side they are on: of a closed body too the surface may have rims there, which
// edge_census() counts as boundary edges. Elsewhere a support is no narrower than three times the
// distance to the nearest sample, so that an edge's fits weigh all its sides. Throws scan::Error:
// usage for options outside their limits, input for fewer than 16 valid points or a cloud without
// extent, computation for an empty surface.
SurfaceResult mls(const PointCloud& cloud, const MlsOptions& options = {},
                  const Progress& progress = {});

}  // namespace scan
