// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/collapsing_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

#include "libscan/reconstruct/support.h"

namespace scan {
namespace {

constexpr double least_cosine = 0.5;  // of 60 degrees
constexpr double least_roundness = 0.01;
constexpr double flat = 1e-6;

struct Shape {
  Eigen::Vector3d twice_area;
  double roundness;  // height over the longest side

  Shape(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : twice_area((b - a).cross(c - a)) {
    const double longest2 =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    roundness = longest2 > 0 ? twice_area.norm() / longest2 : 0;
    if (roundness < flat) roundness = 0;  // rounding
  }
};

}  // namespace

CollapsingMesh::CollapsingMesh(const Mesh& mesh)
    : mesh_(mesh),
      is_alive_(mesh.triangles.size(), 1),
      around_(mesh.vertices.size()),
      alive_(mesh.triangles.size()) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) around_[v].push_back(t);
}

bool CollapsingMesh::names(std::uint32_t t, std::uint32_t vertex) const {
  const Triangle& corners = mesh_.triangles[t];
  return std::find(corners.begin(), corners.end(), vertex) != corners.end();
}

std::vector<std::uint32_t> CollapsingMesh::neighbours(std::uint32_t vertex) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t t : around_[vertex])
    for (const std::uint32_t v : mesh_.triangles[t])
      if (v != vertex) found.push_back(v);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Inside the surface a vertex has as many neighbours as triangles.
bool CollapsingMesh::is_on_rim(std::uint32_t vertex) const {
  return neighbours(vertex).size() != around_[vertex].size();
}

bool CollapsingMesh::keeps_shape(std::uint32_t moved, std::uint32_t other,
                                 const Eigen::Vector3d& place) const {
  // Where a thin triangle faces is chance: it goes by those around.
  Eigen::Vector3d star_side = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : {moved, other})
    for (const std::uint32_t t : around_[v]) star_side += area_vector(mesh_, mesh_.triangles[t]);
  for (const std::uint32_t t : around_[moved]) {
    if (names(t, other)) continue;
    const Triangle& c = mesh_.triangles[t];
    const auto corner = [&](int k) { return c[k] == moved ? place : mesh_.vertices[c[k]]; };
    const Shape before(at(c[0]), at(c[1]), at(c[2])), after(corner(0), corner(1), corner(2));
    if (after.roundness < std::min(least_roundness, before.roundness)) return false;
    if (after.roundness < least_roundness) continue;
    const Eigen::Vector3d& side =
        before.roundness > least_roundness ? before.twice_area : star_side;
    if (side.dot(after.twice_area) < least_cosine * side.norm() * after.twice_area.norm())
      return false;
  }
  return true;
}

bool CollapsingMesh::may_collapse(std::uint32_t kept, std::uint32_t gone,
                                  const Eigen::Vector3d& place) const {
  const auto a = neighbours(kept), b = neighbours(gone);
  std::vector<std::uint32_t> shared;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(shared));
  const auto triangles = static_cast<std::size_t>(std::count_if(
      around_[kept].begin(), around_[kept].end(), [&](std::uint32_t t) { return names(t, gone); }));
  if (shared.size() != triangles || alive_ <= 4) return false;
  const bool rims = a.size() != around_[kept].size() && b.size() != around_[gone].size();
  if (rims && triangles != 1) return false;  // a bridge between two rims
  // A vertex of three triangles would leave two that lie on one another.
  for (const std::uint32_t v : shared)
    if (around_[v].size() <= 3 && !is_on_rim(v)) return false;
  return keeps_shape(kept, gone, place) && keeps_shape(gone, kept, place);
}

void CollapsingMesh::collapse(std::uint32_t kept, std::uint32_t gone,
                              const Eigen::Vector3d& place) {
  for (const std::uint32_t t : around_[gone]) {
    if (!names(t, kept)) {
      std::replace(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), gone, kept);
      around_[kept].push_back(t);
      continue;
    }
    is_alive_[t] = 0;
    --alive_;
    for (const std::uint32_t v : mesh_.triangles[t])
      if (v != gone) std::erase(around_[v], t);
  }
  around_[gone] = {};
  std::sort(around_[kept].begin(), around_[kept].end());
  mesh_.vertices[kept] = place;
}

std::uint32_t CollapsingMesh::triangle_of(std::uint32_t a, std::uint32_t b) const {
  for (const std::uint32_t t : around_[a])
    for (int k = 0; k < 3; ++k)
      if (mesh_.triangles[t][k] == a && mesh_.triangles[t][(k + 1) % 3] == b) return t;
  return static_cast<std::uint32_t>(mesh_.triangles.size());
}

std::uint32_t CollapsingMesh::corner_beside(std::uint32_t t, std::uint32_t a,
                                            std::uint32_t b) const {
  const Triangle& c = mesh_.triangles[t];
  return *std::find_if(c.begin(), c.end(), [&](std::uint32_t v) { return v != a && v != b; });
}

bool CollapsingMesh::may_flip(std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t one = triangle_of(a, b), two = triangle_of(b, a);
  if (std::max(one, two) == mesh_.triangles.size()) return false;
  const std::uint32_t c = corner_beside(one, a, b), d = corner_beside(two, a, b);
  const auto beside_c = neighbours(c);
  if (c == d || std::binary_search(beside_c.begin(), beside_c.end(), d)) return false;
  const Shape old_one(at(a), at(b), at(c)), old_two(at(b), at(a), at(d));
  if (std::max(old_one.roundness, old_two.roundness) <= sliver_height)
    return (at(c) - at(d)).squaredNorm() < (at(a) - at(b)).squaredNorm();
  const Eigen::Vector3d& side =
      old_one.roundness > old_two.roundness ? old_one.twice_area : old_two.twice_area;
  for (const Shape& half : {Shape(at(a), at(d), at(c)), Shape(at(d), at(b), at(c))}) {
    if (half.roundness <= std::min(old_one.roundness, old_two.roundness)) return false;
    if (side.dot(half.twice_area) < least_cosine * side.norm() * half.twice_area.norm())
      return false;
  }
  return true;
}

void CollapsingMesh::flip(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t one = triangle_of(a, b), two = triangle_of(b, a);
  const std::uint32_t c = corner_beside(one, a, b), d = corner_beside(two, a, b);
  mesh_.triangles[one] = {a, d, c};
  mesh_.triangles[two] = {d, b, c};
  std::erase(around_[b], one);
  std::erase(around_[a], two);
  for (const auto& [vertex, triangle] : {std::pair(d, one), std::pair(c, two)}) {
    around_[vertex].push_back(triangle);
    std::sort(around_[vertex].begin(), around_[vertex].end());
  }
}

Mesh CollapsingMesh::mesh() const {
  std::vector<std::uint32_t> vertex_of;
  return mesh(vertex_of);
}

Mesh CollapsingMesh::mesh(std::vector<std::uint32_t>& vertex_of) const {
  return kept_triangles(mesh_, is_alive_, vertex_of);
}

}  // namespace scan
