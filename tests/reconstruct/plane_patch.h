// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A square of the plane z = 0 as a mesh and as points on a grid.
#pragma once

#include "libscan/reconstruct/surface_result.h"
#include "tests/reconstruct/shapes.h"

namespace scan {

// Of `side` cells of width 1, its middle at the origin.
inline Mesh square_mesh(int side) {
  Mesh mesh;
  for (int row = 0; row <= side; ++row)
    for (int column = 0; column <= side; ++column)
      mesh.vertices.emplace_back(column - side / 2.0, row - side / 2.0, 0);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const auto at = static_cast<std::uint32_t>(row * (side + 1) + column);
      const auto above = at + static_cast<std::uint32_t>(side) + 1;
      mesh.triangles.push_back({at, at + 1, above + 1});
      mesh.triangles.push_back({at, above + 1, above});
    }
  return mesh;
}

// side^2 points, row by row, `pitch` apart about the origin.
inline PointCloud square_points(int side, double pitch) {
  PointCloud cloud;
  for (int i = 0; i < side * side; ++i) {
    cloud.points.emplace_back((i % side - (side - 1) / 2.0) * pitch,
                              (i / side - (side - 1) / 2.0) * pitch, 0);
    cloud.normals.push_back(Eigen::Vector3d::UnitZ());
  }
  return cloud;
}

inline SurfaceResult smoothed_square(int side, double length_m) {
  SurfaceResult surface{.surface = square_mesh(side)};
  surface.vertex_smoothing_m.assign(surface.surface.vertices.size(), length_m);
  return surface;
}

// The number of the vertex nearest to the middle of an even square.
inline std::size_t middle_of(int side) {
  return static_cast<std::size_t>(side / 2 * (side + 1) + side / 2);
}

}  // namespace scan
