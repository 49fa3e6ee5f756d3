// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The cells of one depth that a level set crosses, with what its mesh needs of them.
#pragma once

#include "libscan/reconstruct/blended_field.h"
#include "libscan/reconstruct/cell_polygons.h"

namespace scan {

using CellPlace = std::array<std::int32_t, 3>;

// There may be millions: 64 bytes each.
struct CrossedCell {
  CellPlace place;
  std::uint32_t first_vertex = 0;  // of the edges at its lowest corner, then of its centres
  std::uint32_t first_centre = 0;
  CellPolygons polygons;
  std::array<double, 3> crossing;  // parameter along x, y, z from the lowest corner; -1: none
};

struct CrossedCells {
  std::vector<CrossedCell> cells;        // sorted by sort_key(place)
  std::vector<Eigen::Vector3d> centres;  // in the cell, of the loops that need one
};

inline CellPlace sort_key(const CellPlace& place) {
  return {place[2], place[1], place[0]};
}

// Loops of up to five edges meet each face once, so that no diagonal of theirs lies in a face,
// where a neighbour could have the same one. Others get a vertex in their middle.
inline bool needs_centre(int loop_size) {
  return loop_size > 5;
}

// Found from coarse to fine: a cell whose 27 coefficients have one sign holds no zero, since
// splines are convex combinations. Edges at the lowest corner: along x, y, z they are edges 0, 4
// and 8.
CrossedCells crossed_cells(const SplineField& field, int depth);
CrossedCells crossed_cells(const BlendedField& field, int depth);

}  // namespace scan
