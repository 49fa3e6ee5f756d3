// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/trim.h"

#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/reconstruct/support.h"

namespace scan {
namespace {

void keep_only(SurfaceResult& result, const std::vector<char>& keep) {
  std::vector<std::uint32_t> vertex_of;
  result.surface = kept_triangles(result.surface, keep, vertex_of);
  const auto keep_of = [&](std::vector<double>& values) {
    if (values.empty()) return;
    std::vector<double> kept;
    kept.reserve(vertex_of.size());
    for (const std::uint32_t v : vertex_of) kept.push_back(values[v]);
    values = std::move(kept);
  };
  keep_of(result.support_m);
  keep_of(result.data_spacing_m);
  keep_of(result.standard_error_m);
  keep_of(result.vertex_smoothing_m);
}

std::vector<char> large_components(const Mesh& mesh, double min_fraction) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  std::vector<double> area;
  double total = 0;
  for (std::size_t t = 0; t < component.size(); ++t) {
    if (component[t] == area.size()) area.push_back(0);
    const double twice = area_vector(mesh, mesh.triangles[t]).norm();
    area[component[t]] += twice;
    total += twice;
  }
  std::vector<char> keep(component.size());
  for (std::size_t t = 0; t < keep.size(); ++t)
    keep[t] = area[component[t]] >= min_fraction * total;
  return keep;
}

}  // namespace

TrimReport trim(SurfaceResult& result, double max_support_m, double min_component_fraction) {
  if (!(max_support_m >= 0))
    throw Error(Trouble::usage, "trim: distance " + std::to_string(max_support_m) + " m, least 0");
  if (!(min_component_fraction >= 0 && min_component_fraction <= 1))
    throw Error(Trouble::usage, "trim: component fraction " +
                                    std::to_string(min_component_fraction) + ", limits 0 and 1");
  if (result.support_m.size() != result.surface.vertices.size())
    throw Error(Trouble::usage, "trim: the surface has " +
                                    std::to_string(result.surface.vertices.size()) +
                                    " vertices but " + std::to_string(result.support_m.size()) +
                                    " distances to the data");
  const std::size_t triangles = result.surface.triangles.size();
  const double area = area_m2(result.surface);
  std::vector<char> keep(triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    keep[t] = 1;
    for (const std::uint32_t v : result.surface.triangles[t])
      keep[t] = keep[t] && result.support_m[v] <= max_support_m;
  }
  keep_only(result, keep);
  keep_only(result, large_components(result.surface, min_component_fraction));
  const double removed_area_m2 = area - area_m2(result.surface);
  result.trimmed_area_m2 += removed_area_m2;
  return {removed_area_m2, triangles - result.surface.triangles.size()};
}

}  // namespace scan
