// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The zero level set of a spline field as a closed, oriented, manifold mesh.
#pragma once

#include "libscan/core/mesh.h"
#include "libscan/reconstruct/blended_field.h"

namespace scan {

// On the cells of one depth (not above the field's finest), found from coarse to fine: a cell whose
// 27 coefficients have one sign holds no zero, since splines are convex combinations. Vertices are
// the roots along cell edges, where the function is a parabola; they are kept 5e-4 of an edge off
// its ends, so that no triangle collapses. The unit cube's walls count as outside, which closes
// the surface there. Vertices in unit-cube coordinates; inside is where the function is negative.
Mesh zero_level_set(const SplineField& field, int depth);
Mesh zero_level_set(const BlendedField& field, int depth);

}  // namespace scan
