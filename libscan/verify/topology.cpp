// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The topology of a measured surface, and what of it no data supports, as measurements.
#include <algorithm>
#include <limits>
#include <string>

#include "libscan/core/error.h"
#include "libscan/verify/surface_error.h"

namespace scan {

std::vector<Measurement> topology(const Mesh& mesh) {
  check(mesh);
  const EdgeCensus census = edge_census(mesh);
  const auto figure = [](const char* name, double value, const char* over, std::size_t count) {
    return Measurement{.name = name, .value = value, .unit = "count", .over = over, .count = count};
  };
  const bool manifold = census.watertight && census.non_manifold_vertices == 0;
  const double genus =
      manifold ? static_cast<double>(census.genus) : std::numeric_limits<double>::quiet_NaN();
  return {
      figure("components", static_cast<double>(census.components),
             "triangles connected by vertices", mesh.triangles.size()),
      figure("boundary_edges", static_cast<double>(census.boundary_edges), "edges", census.edges),
      figure("non_manifold_edges", static_cast<double>(census.non_manifold_edges), "edges",
             census.edges),
      figure("genus", genus, "all components; undefined unless closed and manifold",
             census.components)};
}

Measurement unsupported_area(const Mesh& mesh, std::span<const double> support_spacings,
                             int most_spacings) {
  check(mesh);
  if (support_spacings.size() != mesh.vertices.size())
    throw Error(Trouble::input, "unsupported area: " + std::to_string(support_spacings.size()) +
                                    " distances to the data for " +
                                    std::to_string(mesh.vertices.size()) + " vertices");
  double unsupported = 0, all = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const double area = area_vector(mesh, triangle).norm();
    const bool is_supported = std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) {
      return support_spacings[v] <= most_spacings;
    });
    if (!is_supported) unsupported += area;
    all += area;
  }
  return {.name = "unsupported_area",
          .value = unsupported / all,
          .unit = "1",
          .over = "area; supported where the nearest data are within " +
                  std::to_string(most_spacings) + " of their spacings",
          .count = mesh.triangles.size()};
}

}  // namespace scan
