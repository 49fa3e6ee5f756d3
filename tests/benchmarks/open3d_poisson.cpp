// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>

#include "tests/benchmarks/reconstruct_peers.h"

namespace scan {

Mesh open3d_poisson(const PointCloud& cloud) {
  open3d::geometry::PointCloud input(cloud.points);
  input.normals_ = cloud.normals;
  const auto [surface, densities] =
      open3d::geometry::TriangleMesh::CreateFromPointCloudPoisson(input, 9);
  Mesh mesh;
  mesh.vertices = surface->vertices_;
  for (const auto& t : surface->triangles_)
    mesh.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                              static_cast<std::uint32_t>(t[2])});
  return mesh;
}

}  // namespace scan
