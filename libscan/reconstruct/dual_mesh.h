// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A surface of quads, dual to one that was cut out of cells.
#pragma once

#include <span>

#include "libscan/reconstruct/one_sided_fits.h"
#include "libscan/reconstruct/surface_result.h"

namespace scan {

// Replaces the surface: a vertex for each piece of it in a cell, where the planes of the piece's
// vertices meet best (Ju et al. 2002) if that is in its cell, and a quad for each vertex about
// which four pieces lie (Nielson 2004); other polygons become triangles about their middle. Closed,
// oriented and manifold if the surface was, and of its topology; a rim recedes by up to a cell.
// With `sharp`, vertices in cells that an edge or a corner runs through lie on it. Support is
// measured anew, the standard error is the mean of the piece's. Throws scan::Error (usage) for a
// surface that was not cut out of cells (`cells`).
SharpReport make_dual(SurfaceResult& result, std::span<const Eigen::Vector3d> points,
                      const OneSidedFits* sharp = nullptr);

// How far from flat a mesh's quads are: the distance between the lines of their diagonals over the
// mean length of these, root mean square and largest; 0 for none.
struct QuadWarp {
  double rms = 0, largest = 0;
};
QuadWarp quad_warp(const Mesh& mesh);

}  // namespace scan
