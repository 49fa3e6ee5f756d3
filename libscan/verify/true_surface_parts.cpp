// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Inside, hidden and nearest for the parts of a true surface.
#include "libscan/verify/true_surface_parts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace scan {
namespace {

// Angle-weighted vertex normals: their sign is right for every point whose nearest point is the
// vertex (Baerentzen and Aanaes 2005, theorem 1).
std::vector<Eigen::Vector3d> angle_weighted_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d normal = area_vector(mesh, t).normalized();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& corner = mesh.vertices[t[k]];
      const Eigen::Vector3d to_next = mesh.vertices[t[(k + 1) % 3]] - corner;
      const Eigen::Vector3d to_last = mesh.vertices[t[(k + 2) % 3]] - corner;
      normals[t[k]] += std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last)) * normal;
    }
  }
  return normals;
}

struct DirectedEdge {
  std::uint32_t low, high, triangle, side;
};

// For each side of each triangle the triangle beyond it; itself where there is not exactly one.
std::vector<Triangle> triangles_across(const Mesh& mesh) {
  std::vector<DirectedEdge> edges;
  std::vector<Triangle> across(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), i, k});
      across[i][k] = i;
    }
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.side) <
           std::tie(b.low, b.high, b.triangle, b.side);
  });
  const auto same = [](const DirectedEdge& a, const DirectedEdge& b) {
    return a.low == b.low && a.high == b.high;
  };
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && same(edges[i], edges[end])) ++end;
    if (end - i == 2) {
      across[edges[i].triangle][edges[i].side] = edges[i + 1].triangle;
      across[edges[i + 1].triangle][edges[i + 1].side] = edges[i].triangle;
    }
    i = end;
  }
  return across;
}

const Mesh& checked(const Mesh& mesh) {
  check(mesh);
  return mesh;
}

}  // namespace

MeshPart::MeshPart(const Mesh& mesh)
    : mesh_(checked(mesh)),
      search_(mesh_),
      corner_normals_(angle_weighted_normals(mesh_)),
      neighbour_(triangles_across(mesh_)),
      solid_(edge_census(mesh_).watertight) {}

Eigen::Vector3d MeshPart::triangle_normal(std::uint32_t triangle) const {
  return area_vector(mesh_, mesh_.triangles[triangle]).normalized();
}

// Corner, edge or face normal, by the barycentric coordinates of the point.
Eigen::Vector3d MeshPart::pseudo_normal(std::uint32_t triangle,
                                        const Eigen::Vector3d& point) const {
  const Triangle& t = mesh_.triangles[triangle];
  const Eigen::Vector3d area = area_vector(mesh_, t);
  const double scale = area.squaredNorm();
  std::array<bool, 3> on_corner_opposite{};  // coordinate k is zero: the side facing corner k
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d b = mesh_.vertices[t[(k + 1) % 3]] - point;
    const Eigen::Vector3d c = mesh_.vertices[t[(k + 2) % 3]] - point;
    on_corner_opposite[k] = std::abs(b.cross(c).dot(area)) <= 1e-9 * scale;
  }
  for (int k = 0; k < 3; ++k)
    if (on_corner_opposite[(k + 1) % 3] && on_corner_opposite[(k + 2) % 3])
      return corner_normals_[t[k]].normalized();
  for (int k = 0; k < 3; ++k)
    if (on_corner_opposite[k]) {
      const std::uint32_t across = neighbour_[triangle][(k + 1) % 3];
      return (triangle_normal(triangle) + triangle_normal(across)).normalized();
    }
  return area.normalized();
}

PartNearest MeshPart::nearest(const Eigen::Vector3d& x, std::uint32_t guess) const {
  const ClosestPoint closest = search_.closest(x, guess);
  const Eigen::Vector3d normal = pseudo_normal(closest.triangle, closest.point);
  const bool behind = normal.dot(x - closest.point) < 0;
  return {closest.point, normal, behind ? -closest.distance_m : closest.distance_m,
          closest.triangle};
}

TrueSurfaceParts::TrueSurfaceParts(const TrueSurface& surface) : shapes(surface.shapes) {
  for (const PlacedShape& shape : shapes) {
    check(shape.shape);
    const Bounds box = bounds_of(shape);
    if (box.sizes().allFinite()) bounds.extend(box);
  }
  for (const Mesh& mesh : surface.meshes) {
    meshes.push_back(std::make_unique<MeshPart>(mesh));
    bounds.extend(bounds_of(mesh.vertices));
  }
  all_shapes.shape = CombinedShape{.parts = shapes};
  // Far above the rounding of a surface point and far below what is worth measuring.
  const double reach_m =
      bounds.isEmpty() ? 0 : bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).norm();
  outer_step_m = 1e-12 + 1e-14 * reach_m + (bounds.isEmpty() ? 0 : 1e-9 * bounds.diagonal().norm());
}

bool TrueSurfaceParts::contains(std::size_t part, const Eigen::Vector3d& x) const {
  if (part < shapes.size()) return field(shapes[part], x).value_m < 0;
  const MeshPart& mesh = *meshes[part - shapes.size()];
  return mesh.is_solid() && mesh.nearest(x).signed_distance_m < 0;
}

bool TrueSurfaceParts::is_hidden(std::size_t part, const Eigen::Vector3d& point,
                                 const Eigen::Vector3d& normal) const {
  const Eigen::Vector3d just_outside = point + outer_step_m * normal;
  for (std::size_t other = 0; other < size(); ++other)
    if (other != part && contains(other, just_outside)) return true;
  return false;
}

}  // namespace scan
