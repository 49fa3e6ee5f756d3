// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <pcl/surface/poisson.h>

#include "tests/benchmarks/reconstruct_peers.h"

namespace scan {

Mesh pcl_poisson(const PointCloud& cloud) {
  auto input = std::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    pcl::PointNormal point;
    point.getVector3fMap() = cloud.points[i].cast<float>();
    point.getNormalVector3fMap() = cloud.normals[i].cast<float>();
    input->push_back(point);
  }
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(8);
  poisson.setInputCloud(input);
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> triangles;
  poisson.performReconstruction(vertices, triangles);
  Mesh mesh;
  for (const auto& vertex : vertices)
    mesh.vertices.push_back(vertex.getVector3fMap().cast<double>());
  for (const auto& t : triangles)
    mesh.triangles.push_back({static_cast<std::uint32_t>(t.vertices[0]),
                              static_cast<std::uint32_t>(t.vertices[1]),
                              static_cast<std::uint32_t>(t.vertices[2])});
  return mesh;
}

}  // namespace scan
