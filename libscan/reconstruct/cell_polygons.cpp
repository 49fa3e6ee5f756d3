// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cell_polygons.h"

namespace scan {
namespace {

// Corners of each face, counter-clockwise as seen from outside the cube.
constexpr int face_corners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

int edge_between(int a, int b) {
  const int axis = (a ^ b) >> 1;  // 1, 2, 4 -> 0, 1, 2
  const int low = a & b;
  const int x = low & 1, y = low >> 1 & 1, z = low >> 2;
  const int first = axis == 0 ? y : x, second = axis == 2 ? y : z;
  return 4 * axis + first + 2 * second;
}

// Where the walk around a face enters the inside (start of a segment) and leaves it (end).
struct FaceCrossings {
  std::array<int, 2> enter{}, leave{};
  int count = 0;
};

FaceCrossings crossings_of(const int (&corners)[4], const std::array<double, 8>& values) {
  FaceCrossings found;
  int entered = 0, left = 0;
  for (int i = 0; i < 4; ++i) {
    const int a = corners[i], b = corners[(i + 1) % 4];
    if (values[a] >= 0 && values[b] < 0) found.enter[entered++] = edge_between(a, b);
    if (values[a] < 0 && values[b] >= 0) found.leave[left++] = edge_between(a, b);
  }
  found.count = entered;
  // Each run of inside corners: its enter before its leave.
  if (entered == 1 || values[corners[0]] >= 0) return found;
  std::swap(found.leave[0], found.leave[1]);
  return found;
}

bool inside_is_joined(const int (&corners)[4], const std::array<double, 8>& values) {
  // f00 f11 - f01 f10 against the sign of its divisor: the saddle's sign, without a division.
  const double even = values[corners[0]] * values[corners[2]];
  const double odd = values[corners[1]] * values[corners[3]];
  return values[corners[0]] < 0 ? even > odd : odd > even;
}

}  // namespace

int edge_start_corner(int edge) {
  const int axis = edge / 4, first = edge & 1, second = edge >> 1 & 1;
  if (axis == 0) return first << 1 | second << 2;
  if (axis == 1) return first | second << 2;
  return first | second << 1;
}

CellPolygons cell_polygons(const std::array<double, 8>& values) {
  std::array<int, 12> next;
  next.fill(-1);
  for (const auto& corners : face_corners) {
    const FaceCrossings at = crossings_of(corners, values);
    const bool swap = at.count == 2 && inside_is_joined(corners, values);
    for (int i = 0; i < at.count; ++i) next[at.enter[i]] = at.leave[swap ? 1 - i : i];
  }
  CellPolygons polygons;
  int used = 0;
  for (int start = 0; start < 12; ++start) {
    if (next[start] < 0) continue;
    const int first = used;
    for (int edge = start; next[edge] >= 0;) {
      polygons.edges[used++] = static_cast<signed char>(edge);
      const int following = next[edge];
      next[edge] = -1;
      edge = following;
    }
    polygons.sizes[polygons.loops++] = static_cast<signed char>(used - first);
  }
  return polygons;
}

}  // namespace scan
