// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/interpolating_surface.h"

#include <cmath>
#include <string>

#include "libscan/core/error.h"
#include "libscan/reconstruct/support.h"

namespace scan {
namespace {

// Turns each component so that most of its area agrees with its vertices' normals.
void follow_normals(const PointCloud& cloud, const std::vector<std::uint32_t>& point_of_vertex,
                    Mesh& mesh) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  std::vector<double> agreement;
  for (std::size_t t = 0; t < component.size(); ++t) {
    if (component[t] == agreement.size()) agreement.push_back(0);
    const Eigen::Vector3d area = area_vector(mesh, mesh.triangles[t]);
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Eigen::Vector3d& normal = cloud.normals[point_of_vertex[v]];
      if (normal.allFinite()) agreement[component[t]] += area.dot(normal);
    }
  }
  for (std::size_t t = 0; t < component.size(); ++t)
    if (agreement[component[t]] < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

// About the origin and of a size near 1, by a power of two, which rounds nothing: CGAL's front
// gives up on an object of a micrometre.
std::vector<Eigen::Vector3d> about_one(const std::vector<Eigen::Vector3d>& points) {
  const Bounds box = bounds_of(points);
  const double extent = box.sizes().maxCoeff();
  const double scale = extent > 0 ? std::exp2(-std::round(std::log2(extent))) : 1;
  std::vector<Eigen::Vector3d> moved;
  moved.reserve(points.size());
  for (const auto& x : points) moved.push_back(scale * (x - box.center()));
  return moved;
}

}  // namespace

SurfaceResult interpolating_surface(const PointCloud& cloud, const Triangulate& triangulate,
                                    const char* method) {
  check(cloud);
  const Stopwatch watch;
  std::vector<std::uint32_t> valid;
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (cloud.points[i].allFinite()) {
      valid.push_back(i);
      points.push_back(cloud.points[i]);
    }
  if (points.size() < 4)
    throw Error(Trouble::input,
                "cloud: " + std::to_string(points.size()) + " finite points, at least 4 needed");
  Mesh all = triangulate(about_one(points));
  all.vertices = points;
  if (all.empty())
    throw Error(Trouble::computation, std::string(method) + ": no triangle fits the points",
                "points on a line or at one place span no surface");
  SurfaceResult result;
  std::vector<std::uint32_t> vertex_of;
  result.surface = kept_triangles(all, std::vector<char>(all.triangles.size(), 1), vertex_of);
  for (std::uint32_t& v : vertex_of) v = valid[v];
  if (!cloud.normals.empty()) follow_normals(cloud, vertex_of, result.surface);
  sort_triangles(result.surface);
  result.support_m.assign(result.surface.vertices.size(), 0.0);  // its vertices are data
  result.unknowns = points.size();
  result.stop = SolveStop::direct;
  result.invalid_points = cloud.size() - valid.size();
  result.cost.seconds = watch.seconds();
  return result;
}

}  // namespace scan
