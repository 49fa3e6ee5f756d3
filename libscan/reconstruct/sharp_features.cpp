// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/sharp_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/one_sided_fits.h"
#include "libscan/reconstruct/slivers.h"
#include "libscan/reconstruct/split_triangles.h"
#include "libscan/reconstruct/support.h"

namespace scan {
namespace {

constexpr double across_cosine = 0.8660254;  // of 30 degrees: an edge of the mesh crosses
constexpr double snap_share = 0.25;          // of a mesh edge: a vertex so near goes there itself
constexpr double least_share = 0.05;         // of a mesh edge: no vertex is put nearer to another

// The pieces that a vertex lies on, by their normals there; none: away from features.
struct Sides {
  std::array<Eigen::Vector3d, 2> normals;
  int count = 0;
  bool agree_with(const Sides& other) const {
    if (count == 0 || other.count == 0) return true;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < other.count; ++j)
        if (normals[i].dot(other.normals[j]) > across_cosine) return true;
    return false;
  }
};

class Sharpener {
 public:
  Sharpener(Mesh& mesh, const OneSidedFits& fits)
      : mesh_(mesh), fits_(fits), sides_(mesh.vertices.size()) {}

  void run() {
    project();
    find_crossings();
    snap();
    keep_apart();
    find_corners();
  }

  SplitMesh split() const { return split_triangles(mesh_, crossings_, corners_); }
  // Of each vertex of the split mesh, whether it is new or may have been moved.
  std::vector<char> touched(const SplitMesh& split) const {
    std::vector<char> marks(split.mesh.vertices.size(), 1);
    for (std::size_t v = 0; v < sides_.size(); ++v) marks[v] = sides_[v].count > 0;
    return marks;
  }
  const SharpReport& report() const { return report_; }

 private:
  void project() {
    std::vector<char> moved(mesh_.vertices.size(), 0);
    parallel_for(mesh_.vertices.size(), [&](std::size_t v) {
      const SharpSurface surface = fits_.about(mesh_.vertices[v]);
      if (surface.count == 0) return;
      const Eigen::Vector3d start = mesh_.vertices[v];
      const Eigen::Vector3d x = surface.onto(start);
      if (!x.allFinite() || (x - start).norm() > 2 * fits_.spacing_at(start)) return;
      mesh_.vertices[v] = x;
      sides_[v].normals[0] = surface.pieces[surface.at(x).piece].normal(x);
      sides_[v].count = 1;
      moved[v] = 1;
    });
    report_.moved_vertices = static_cast<std::size_t>(std::count(moved.begin(), moved.end(), 1));
  }

  bool crosses(const MeshEdge& e) const { return !sides_[e[0]].agree_with(sides_[e[1]]); }

  // Where the pieces of an edge's ends meet, if that is near the edge.
  bool meeting(const MeshEdge& e, Eigen::Vector3d& place) const {
    const Eigen::Vector3d middle = (mesh_.vertices[e[0]] + mesh_.vertices[e[1]]) / 2;
    const SharpSurface surface = fits_.about(middle);
    if (surface.count == 0) return false;
    const int named[2] = {surface.piece_like(sides_[e[0]].normals[0], middle),
                          surface.piece_like(sides_[e[1]].normals[0], middle)};
    if (named[0] == named[1]) return false;
    place = surface.meeting_place(named, middle);
    return place.allFinite() && (place - middle).norm() < length(e);
  }

  double length(const MeshEdge& e) const {
    return (mesh_.vertices[e[0]] - mesh_.vertices[e[1]]).norm();
  }

  void find_crossings() {
    std::vector<MeshEdge> edges;
    for (const Triangle& t : mesh_.triangles)
      for (int k = 0; k < 3; ++k) {
        const MeshEdge e = mesh_edge(t[k], t[(k + 1) % 3]);
        if (t[k] < t[(k + 1) % 3] && crosses(e)) edges.push_back(e);
      }
    std::sort(edges.begin(), edges.end());
    std::vector<Eigen::Vector3d> places(edges.size());
    std::vector<char> found(edges.size());
    parallel_for(edges.size(), [&](std::size_t i) { found[i] = meeting(edges[i], places[i]); });
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (found[i]) crossings_[edges[i]] = places[i];
  }

  bool is_corner(const Triangle& t) const {
    return crossings_.contains(mesh_edge(t[0], t[1])) &&
           crossings_.contains(mesh_edge(t[1], t[2])) && crossings_.contains(mesh_edge(t[2], t[0]));
  }

  struct Snap {
    double distance;
    std::uint32_t vertex;
    MeshEdge edge;
    bool operator<(const Snap& other) const {
      return std::tie(distance, vertex, edge) < std::tie(other.distance, other.vertex, other.edge);
    }
  };

  // A vertex next to a feature goes there, unless that would lay a triangle flat along it.
  void snap() {
    std::vector<Snap> wanted;
    for (const auto& [e, place] : crossings_)
      for (const std::uint32_t v : e) {
        const double distance = (mesh_.vertices[v] - place).norm();
        if (distance < snap_share * length(e)) wanted.push_back({distance, v, e});
      }
    std::sort(wanted.begin(), wanted.end());
    std::map<std::uint32_t, std::vector<Triangle>> around;
    for (const Snap& s : wanted) around[s.vertex];
    for (const Triangle& t : mesh_.triangles)
      for (const std::uint32_t v : t)
        if (const auto at = around.find(v); at != around.end()) at->second.push_back(t);
    for (const Snap& s : wanted) {
      Sides& sides = sides_[s.vertex];
      const auto& triangles = around[s.vertex];
      if (sides.count == 2 || std::any_of(triangles.begin(), triangles.end(), [&](const auto& t) {
            return is_corner(t) ||
                   sides_[t[0]].count + sides_[t[1]].count + sides_[t[2]].count >= 5;
          }))
        continue;
      const auto other = s.edge[0] == s.vertex ? s.edge[1] : s.edge[0];
      mesh_.vertices[s.vertex] = crossings_.at(s.edge);
      sides.normals[sides.count++] = sides_[other].normals[0];
      ++report_.edge_vertices;
    }
    std::erase_if(crossings_, [&](const auto& crossing) { return !crosses(crossing.first); });
  }

  // A vertex that may not go onto a feature it almost touches steps back from it.
  void keep_apart() {
    for (const auto& [e, place] : crossings_)
      for (const std::uint32_t v : e) {
        const double least = least_share * length(e);
        const std::uint32_t other = e[0] == v ? e[1] : e[0];
        if (sides_[v].count == 2 || (mesh_.vertices[v] - place).norm() >= least) continue;
        Eigen::Vector3d away = mesh_.vertices[v] - mesh_.vertices[other];
        away -= away.dot(sides_[v].normals[0]) * sides_[v].normals[0];
        mesh_.vertices[v] += least * away.normalized();
      }
  }

  void find_corners() {
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      if (!is_corner(t)) continue;
      const Eigen::Vector3d middle =
          (mesh_.vertices[t[0]] + mesh_.vertices[t[1]] + mesh_.vertices[t[2]]) / 3;
      const double size = std::max({length(mesh_edge(t[0], t[1])), length(mesh_edge(t[1], t[2])),
                                    length(mesh_edge(t[2], t[0]))});
      const SharpSurface surface = fits_.about(middle);
      Eigen::Vector3d place = middle;
      if (surface.count == 3) {
        const Eigen::Vector3d found = surface.meeting_place(std::array{0, 1, 2}, middle);
        if (found.allFinite() && (found - middle).norm() < size) place = found;
      }
      corners_[i] = place;
      ++report_.corners;
    }
    report_.edge_vertices += crossings_.size() + report_.corners;
  }

  Mesh& mesh_;
  const OneSidedFits& fits_;
  std::vector<Sides> sides_;
  EdgePlaces crossings_;
  std::map<std::uint32_t, Eigen::Vector3d> corners_;
  SharpReport report_;
};

}  // namespace

SharpReport sharpen(SurfaceResult& result, std::span<const Eigen::Vector3d> points,
                    std::span<const Eigen::Vector3d> normals, std::span<const double> spacing_m) {
  const OneSidedFits fits(points, normals, spacing_m);
  Sharpener sharpener(result.surface, fits);
  sharpener.run();
  SplitMesh split = sharpener.split();
  std::vector<std::uint32_t> vertex_of;
  result.surface = without_slivers(split.mesh, sharpener.touched(split), vertex_of);
  result.support_m = distance_to_points(result.surface, points);
  for (std::vector<double>* values : {&result.standard_error_m, &result.vertex_smoothing_m}) {
    if (values->empty()) continue;
    for (const MeshEdge& from : split.new_between)
      values->push_back(std::max((*values)[from[0]], (*values)[from[1]]));
    std::vector<double> kept;
    for (const std::uint32_t v : vertex_of) kept.push_back((*values)[v]);
    *values = std::move(kept);
  }
  return sharpener.report();
}

}  // namespace scan
