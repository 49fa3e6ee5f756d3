// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The one entry into the part of verify that is built on CGAL's GPL code.
#pragma once

#include <optional>

#include "libscan/core/mesh.h"

namespace scan {

// Pairs of triangles that meet elsewhere than in a shared vertex or edge; none for a mesh that is
// not manifold and oriented. `mesh` has been checked.
std::optional<std::size_t> count_self_intersections(const Mesh& mesh);

}  // namespace scan
