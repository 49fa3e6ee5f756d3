// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Marching cubes by tracing: the polygons in which a level set crosses a cube.
//
// Each face of the cube decides alone how its crossings are joined, from its four corner values, so
// two cubes that share a face always agree. The polygons of all cubes then form a closed surface in
// which every vertex (one per crossed edge) has four polygons around it in one cycle.
#pragma once

#include <array>
#include <vector>

namespace scan {

// Corner c of the cube has the bits x, y, z. Edge e: axis e / 4, from the corner with the other two
// coordinates (e & 1, e >> 1 & 1), in the order of the axes.
int edge_start_corner(int edge);

// Edge loops, counter-clockwise as seen from the positive side. Values below zero are inside. Faces
// with two inside corners across from each other are decided by the sign of the bilinear
// interpolant's saddle (Nielson and Hamann 1991).
struct CellPolygons {
  std::array<signed char, 12> edges;  // all loops one after the other
  std::array<signed char, 4> sizes;   // of each loop
  int loops = 0;
};
CellPolygons cell_polygons(const std::array<double, 8>& corner_values);

}  // namespace scan
