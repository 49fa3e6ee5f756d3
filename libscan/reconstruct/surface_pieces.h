// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A surface cut into pieces along its own edges, and the polygons that join them: its dual.
#pragma once

#include "libscan/core/mesh.h"

namespace scan {

// Cubes side by side, one with its lowest corner at the origin.
struct CellGrid {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double side_m = 0;
};

struct SurfacePieces {
  std::vector<std::uint32_t> of_triangle;
  std::uint32_t count = 0;
};

// The triangles within a cell that hang together by edges. Each triangle must lie in one cell, as
// those of a level set that was cut out cell by cell do.
SurfacePieces pieces_in_cells(const Mesh& mesh, const CellGrid& cells);

// A polygon for each vertex about which three or more pieces lie, of these pieces,
// counter-clockwise as seen from outside. On a rim there are none.
struct PiecePolygons {
  std::vector<std::uint32_t> corners;  // all polygons one after the other
  std::vector<std::uint32_t> sizes;
};

// Of a manifold mesh. Pieces that touch along two arcs, or meet themselves at a vertex, are split
// into their triangles first: then no two polygons run through the same edge the same way, and the
// polygons of a closed surface are a closed manifold of its topology.
PiecePolygons polygons_between(const Mesh& mesh, SurfacePieces& pieces);

}  // namespace scan
