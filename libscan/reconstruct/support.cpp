// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/support.h"

#include <algorithm>
#include <cmath>

#include "libscan/core/disjoint_sets.h"
#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

}  // namespace

std::vector<double> distance_to_points(const Mesh& mesh, std::span<const Eigen::Vector3d> points) {
  const KdTree tree(points);
  std::vector<Neighbour> nearest;
  nearest_of_each(tree, mesh.vertices, unlimited_m, curve_order(mesh.vertices), nearest);
  std::vector<double> distances(mesh.vertices.size());
  for (std::size_t i = 0; i < distances.size(); ++i)
    distances[i] = std::sqrt(nearest[i].distance2_m2);
  return distances;
}

std::vector<double> of_nearest_points(const Mesh& mesh, std::span<const Eigen::Vector3d> points,
                                      std::span<const double> values) {
  const KdTree tree(points);
  std::vector<Neighbour> nearest;
  nearest_of_each(tree, mesh.vertices, unlimited_m, curve_order(mesh.vertices), nearest);
  std::vector<double> found(mesh.vertices.size());
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = values[nearest[i].index];
  return found;
}

std::vector<std::uint32_t> triangle_components(const Mesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (int k = 1; k < 3; ++k) sets.unite(t[0], t[k]);
  std::vector<std::uint32_t> number(mesh.vertices.size(), none), components;
  std::uint32_t count = 0;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& of_root = number[sets.name_of(t[0])];
    if (of_root == none) of_root = count++;
    components.push_back(of_root);
  }
  return components;
}

Mesh kept_triangles(const Mesh& mesh, std::vector<char> keep,
                    std::vector<std::uint32_t>& vertex_of) {
  Mesh kept;
  for (std::size_t q = 0; q < mesh.quads; ++q)
    if (keep[2 * q] && keep[2 * q + 1])
      ++kept.quads;
    else
      keep[2 * q] = keep[2 * q + 1] = 0;
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), none);
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t])
      for (const std::uint32_t v : mesh.triangles[t]) renumbered[v] = 0;
  vertex_of.clear();
  for (std::uint32_t v = 0; v < renumbered.size(); ++v)
    if (renumbered[v] != none) {
      renumbered[v] = static_cast<std::uint32_t>(kept.vertices.size());
      kept.vertices.push_back(mesh.vertices[v]);
      vertex_of.push_back(v);
    }
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t]) {
      const Triangle& old = mesh.triangles[t];
      kept.triangles.push_back({renumbered[old[0]], renumbered[old[1]], renumbered[old[2]]});
    }
  return kept;
}

Mesh supported_components(const Mesh& mesh, std::span<const Eigen::Vector3d> points,
                          std::span<const double> weights, double least_share) {
  const std::vector<std::uint32_t> component = triangle_components(mesh);
  if (component.empty()) return mesh;
  const std::uint32_t count = *std::max_element(component.begin(), component.end()) + 1;
  if (count == 1) return mesh;
  std::vector<std::uint32_t> of_vertex(mesh.vertices.size());
  for (std::size_t t = 0; t < component.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) of_vertex[v] = component[t];
  const KdTree tree(mesh.vertices);
  std::vector<Neighbour> nearest;
  nearest_of_each(tree, points, unlimited_m, curve_order(points), nearest);
  std::vector<double> support(count, 0.0);
  double total = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    support[of_vertex[nearest[i].index]] += weights[i];
    total += weights[i];
  }
  std::vector<char> keep(component.size());
  for (std::size_t t = 0; t < keep.size(); ++t)
    keep[t] = support[component[t]] >= least_share * total;
  std::vector<std::uint32_t> vertex_of;
  return kept_triangles(mesh, keep, vertex_of);
}

void sort_triangles(Mesh& mesh) {
  for (Triangle& t : mesh.triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(mesh.triangles.begin(), mesh.triangles.end());
}

}  // namespace scan
