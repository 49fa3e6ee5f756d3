// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Edges and corners put back where a smooth field has rounded them off.
#pragma once

#include <span>

#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Where the samples' normals tell of an edge or a corner (one_sided_fits.h), moves the vertices
// onto the pieces that meet there, each fitted from its own side, and splits the mesh's edges that
// go from one piece to another where the pieces meet (in the manner of Kobbelt et al. 2001, with
// vertices for dual contouring's quadrics): sharp edges become edges of the mesh. A closed manifold
// stays one. Elsewhere nothing changes, nor where the points scatter by more than a tenth of their
// spacing. `normals`: unit, outward; `spacing_m`: of the samples about each.
SharpReport sharpen(SurfaceResult& result, std::span<const Eigen::Vector3d> points,
                    std::span<const Eigen::Vector3d> normals, std::span<const double> spacing_m);

}  // namespace scan
