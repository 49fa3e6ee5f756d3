// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The topology of a measured surface as measurements.
#include <limits>

#include "libscan/verify/surface_error.h"

namespace scan {

std::vector<Measurement> topology(const Mesh& mesh) {
  check(mesh);
  const EdgeCensus census = edge_census(mesh);
  const auto figure = [](const char* name, double value, const char* over, std::size_t count) {
    return Measurement{
        .name = name, .value = value, .unit = "count", .over = over, .count = count};
  };
  const bool manifold = census.watertight && census.non_manifold_vertices == 0;
  const double genus = manifold ? static_cast<double>(census.genus)
                                : std::numeric_limits<double>::quiet_NaN();
  return {figure("components", static_cast<double>(census.components),
                 "triangles connected by vertices", mesh.triangles.size()),
          figure("boundary_edges", static_cast<double>(census.boundary_edges), "edges",
                 census.edges),
          figure("non_manifold_edges", static_cast<double>(census.non_manifold_edges), "edges",
                 census.edges),
          figure("genus", genus, "all components; undefined unless closed and manifold",
                 census.components)};
}

}  // namespace scan
