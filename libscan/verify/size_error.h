// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// How far the area and the volume of a measured surface are from the true ones.
#pragma once

#include "libscan/verify/truth.h"
#include "libscan/verify/verdict.h"

namespace scan {

// area_error and volume_error: measured over true, less 1. Areas and volumes of meshes are sums
// over their triangles, those of simple shapes closed forms, those of combinations sums over lines
// (solid_size.h), which leave an interval. Only what is defined is returned: truth must be one mesh
// or one shape that is no plane, the volume asks for a closed truth and a closed, manifold measured
// surface. Throws scan::Error (input) for a broken mesh.
std::vector<Measurement> size_error(const Mesh& measured, const TrueSurface& truth);

}  // namespace scan
