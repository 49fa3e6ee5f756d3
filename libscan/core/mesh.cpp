// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/core/mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "libscan/core/disjoint_sets.h"
#include "libscan/core/error.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

// Side k of a triangle runs from its corner k to k + 1; corner k of triangle t is number 3 t + k.
struct HalfEdge {
  std::uint32_t low, high;
  std::uint32_t low_corner, high_corner;
  bool forward;  // runs from low to high
};

std::vector<HalfEdge> sorted_half_edges(const Mesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t next = (k + 1) % 3;
      const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][next];
      const std::uint32_t corner_a = 3 * i + k, corner_b = 3 * i + next;
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? corner_a : corner_b,
                       a < b ? corner_b : corner_a, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::pair(a.low, a.high) < std::pair(b.low, b.high);
  });
  return edges;
}

void count_edges(const std::vector<HalfEdge>& edges, EdgeCensus& census) {
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first, forward = 0;
    for (; last < edges.size() && edges[last].low == edges[first].low &&
           edges[last].high == edges[first].high;
         ++last)
      forward += edges[last].forward;
    const std::size_t uses = last - first;
    ++census.edges;
    census.boundary_edges += uses == 1;
    census.non_manifold_edges += uses > 2;
    census.misoriented_edges += uses == 2 && forward != 1;
    first = last;
  }
}

void count_components(const Mesh& mesh, EdgeCensus& census) {
  DisjointSets sets(mesh.vertices.size());
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      used[v] = 1;
      sets.unite(t[0], v);
    }
  for (std::uint32_t i = 0; i < used.size(); ++i) {
    census.used_vertices += used[i];
    census.components += used[i] && sets.name_of(i) == i;
  }
}

// Corners at a vertex that edges connect form a fan; a manifold vertex has one.
void count_non_manifold_vertices(const Mesh& mesh, const std::vector<HalfEdge>& edges,
                                 EdgeCensus& census) {
  DisjointSets fans(3 * mesh.triangles.size());
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].low == edges[i - 1].low && edges[i].high == edges[i - 1].high) {
      fans.unite(edges[i].low_corner, edges[i - 1].low_corner);
      fans.unite(edges[i].high_corner, edges[i - 1].high_corner);
    }
  std::vector<std::uint32_t> fans_at(mesh.vertices.size(), 0);
  for (std::uint32_t corner = 0; corner < fans.size(); ++corner)
    if (fans.name_of(corner) == corner) ++fans_at[mesh.triangles[corner / 3][corner % 3]];
  for (const std::uint32_t fans_here : fans_at) census.non_manifold_vertices += fans_here > 1;
}

}  // namespace

void check(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      throw Error(Trouble::input, "mesh: vertex " + std::to_string(i) + " is not finite");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i])
      if (v >= mesh.vertices.size())
        throw Error(Trouble::input, "mesh: triangle " + std::to_string(i) + " names vertex " +
                                        std::to_string(v) + " of " +
                                        std::to_string(mesh.vertices.size()));
}

Eigen::Vector3d area_vector(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

double area_m2(const Mesh& mesh) {
  double twice = 0;
  for (const Triangle& t : mesh.triangles) twice += area_vector(mesh, t).norm();
  return twice / 2;
}

double volume_m3(const Mesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Eigen::Vector3d origin = mesh.vertices.front();  // exact far from the world's origin too
  double six_fold = 0;
  for (const Triangle& t : mesh.triangles)
    six_fold += area_vector(mesh, t).dot(mesh.vertices[t[0]] - origin);
  return six_fold / 6;
}

std::vector<Eigen::Vector3d> vertex_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d area = area_vector(mesh, t);
    for (const std::uint32_t v : t) normals[v] += area;
  }
  for (auto& normal : normals)
    if (const double length = normal.norm(); length > 0) normal /= length;
  return normals;
}

Mesh transformed(const Pose& a_from_b, const Mesh& mesh_in_b) {
  Mesh mesh = mesh_in_b;
  for (auto& vertex : mesh.vertices) vertex = a_from_b * vertex;
  return mesh;
}

EdgeCensus edge_census(const Mesh& mesh) {
  EdgeCensus census;
  const auto edges = sorted_half_edges(mesh);
  count_edges(edges, census);
  count_components(mesh, census);
  count_non_manifold_vertices(mesh, edges, census);
  census.euler_characteristic = static_cast<long>(census.used_vertices) -
                                static_cast<long>(census.edges) +
                                static_cast<long>(mesh.triangles.size());
  census.watertight = !mesh.triangles.empty() && census.boundary_edges == 0 &&
                      census.non_manifold_edges == 0 && census.misoriented_edges == 0;
  census.genus = static_cast<long>(census.components) - census.euler_characteristic / 2;
  return census;
}

std::vector<SurfaceSample> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<double> area_up_to(mesh.triangles.size());
  double total = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    area_up_to[i] = total += area_vector(mesh, mesh.triangles[i]).norm() / 2;
  if (!(total > 0)) throw Error(Trouble::input, "mesh: no area to sample");

  std::vector<SurfaceSample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(seed, 0, i);
    const double target =
        total * (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end(), target);
    const auto index = std::min<std::size_t>(found - area_up_to.begin(), area_up_to.size() - 1);
    const Triangle& t = mesh.triangles[index];
    const double root = std::sqrt(random.uniform()), v = random.uniform();
    const double a = 1 - root, b = root * (1 - v), c = root * v;  // Turk 1990, uniform by area
    samples[i] = {a * mesh.vertices[t[0]] + b * mesh.vertices[t[1]] + c * mesh.vertices[t[2]],
                  area_vector(mesh, t).normalized(), static_cast<std::uint32_t>(index)};
  }
  return samples;
}

}  // namespace scan
