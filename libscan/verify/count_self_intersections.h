// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Self-intersections counted by CGAL (GPL): part of the target libscan::cgal.
#pragma once

#include <optional>

#include "libscan/core/mesh.h"

namespace scan {

// Pairs of triangles that meet elsewhere than in a shared vertex or edge; none for a mesh that is
// not manifold and oriented. `mesh` has been checked.
std::optional<std::size_t> count_self_intersections(const Mesh& mesh);

}  // namespace scan
