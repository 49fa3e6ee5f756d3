// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Whether a surface passes through itself, decided exactly by CGAL.
#pragma once

#include <optional>

#include "libscan/core/mesh.h"
#include "libscan/verify/verdict.h"

namespace scan {

// self_intersections: the number of pairs of triangles that meet elsewhere than in a shared vertex
// or edge. None for a mesh that is not manifold and oriented, and in a build without CGAL. Throws
// scan::Error (input) for a broken mesh.
std::optional<Measurement> self_intersection(const Mesh& mesh);

}  // namespace scan
