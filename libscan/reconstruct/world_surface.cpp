// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/world_surface.h"

#include <string>
#include <utility>

#include "libscan/core/error.h"
#include "libscan/reconstruct/support.h"

namespace scan {

SurfaceResult world_surface(Mesh mesh, const Samples& samples, const char* method) {
  constexpr double least_support = 1e-3;
  if (!mesh.empty()) mesh = supported_components(mesh, samples.points, samples.area, least_support);
  if (mesh.empty())
    throw Error(Trouble::computation, std::string(method) + ": no surface fits the points",
                "check that the normals are oriented consistently");
  SurfaceResult result;
  result.support_m = distance_to_points(mesh, samples.points);
  for (double& support : result.support_m) support *= samples.box.side_m;
  for (auto& vertex : mesh.vertices) vertex = samples.box.to_world(vertex);
  result.surface = std::move(mesh);
  result.cells_from_m = samples.box.origin_m;
  result.invalid_points = samples.invalid_points;
  result.outlying_points = samples.outlying_points;
  return result;
}

}  // namespace scan
