// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Triangles of next to no area taken out of a mesh.
#pragma once

#include <span>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

// Collapses the shortest edge of a sliver (collapsing_mesh.h), onto the vertex with the higher
// number if it can; where that edge is long or must stay, flips the longest one. The mesh stays the
// surface that it is: no place moves by more than twice `sliver_height` of a triangle's longest
// side, and a closed manifold stays one. Only triangles with a vertex that is `marked` (one per
// vertex) are looked at. `vertex_of` gets the old index of each vertex.
Mesh without_slivers(const Mesh& mesh, std::span<const char> marked,
                     std::vector<std::uint32_t>& vertex_of);

}  // namespace scan
