// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/dual_mesh.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/reconstruct/support.h"
#include "libscan/reconstruct/surface_pieces.h"

namespace scan {
namespace {

// Of the largest eigenvalue: normals 0.1 rad off their mean. With 0.3 rad a sharp-edged part of
// 20,000 exact points is 12 to 29 % farther off.
constexpr double least_curvature = 0.01;
constexpr double sharp_reach = 1.5;  // in cells: edges lie outside of the rounded surface

using Members = std::vector<std::vector<std::uint32_t>>;

// The vertices of each piece's triangles, ascending.
Members members_of(const Mesh& mesh, const SurfacePieces& pieces) {
  Members members(pieces.count);
  for (std::size_t t = 0; t < pieces.of_triangle.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) members[pieces.of_triangle[t]].push_back(v);
  for (auto& list : members) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return members;
}

class Placer {
 public:
  Placer(const Mesh& mesh, const CellGrid& cells, const OneSidedFits* sharp)
      : mesh_(mesh), cells_(cells), sharp_(sharp), normals_(vertex_normals(mesh)) {}

  struct Placed {
    Eigen::Vector3d at;
    int pieces_met = 0;  // of a sharp surface; 0: there is none
  };

  Placed place(const std::vector<std::uint32_t>& members) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : members) mean += mesh_.vertices[v] - mesh_.vertices[members[0]];
    mean = mesh_.vertices[members[0]] + mean / static_cast<double>(members.size());
    if (sharp_)
      if (Placed placed = on_feature(members, mean); placed.pieces_met > 0) return placed;
    return {meeting_of_planes(members, mean), 0};
  }

 private:
  // The least sum of squared distances from the tangent planes; where these do not say, the mean.
  Eigen::Vector3d meeting_of_planes(const std::vector<std::uint32_t>& members,
                                    const Eigen::Vector3d& mean) const {
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : members) {
      const Eigen::Vector3d& n = normals_[v];
      square += n * n.transpose();
      linear += n.dot(mesh_.vertices[v] - mean) * n;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(square);
    const Eigen::Vector3d& values = solver.eigenvalues();
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i)
      if (values[i] > least_curvature * values[2]) {
        const Eigen::Vector3d axis = solver.eigenvectors().col(i);
        step += axis.dot(linear) / values[i] * axis;
      }
    return is_in_cell_of(mean, mean + step) ? mean + step : mean;
  }

  bool is_in_cell_of(const Eigen::Vector3d& mean, const Eigen::Vector3d& x) const {
    const auto cell = [&](const Eigen::Vector3d& at) {
      return Eigen::Array3d(((at - cells_.origin_m) / cells_.side_m).array().floor());
    };
    return x.allFinite() && (cell(x) == cell(mean)).all();
  }

  // Where the smooth pieces meet that the members lie on, or on the one of them.
  Placed on_feature(const std::vector<std::uint32_t>& members, const Eigen::Vector3d& mean) const {
    const SharpSurface surface = sharp_->about(mean);
    if (surface.count == 0) return {mean, 0};
    std::vector<int> named;
    for (const std::uint32_t v : members) {
      const int piece = surface.at(mesh_.vertices[v]).piece;
      if (std::find(named.begin(), named.end(), piece) == named.end()) named.push_back(piece);
    }
    const Eigen::Vector3d at =
        named.size() == 1 ? surface.onto(mean) : surface.meeting_place(named, mean);
    if (!at.allFinite() || (at - mean).norm() > sharp_reach * cells_.side_m) return {mean, 0};
    return {at, static_cast<int>(named.size())};
  }

  const Mesh& mesh_;
  const CellGrid& cells_;
  const OneSidedFits* sharp_;
  std::vector<Eigen::Vector3d> normals_;
};

// The mesh of the polygons: quads first, each along its shorter diagonal; what is no quad becomes
// triangles about its middle. So does a quad whose diagonal is another's, which is none where each
// edge of the grid has one root: the diagonal's cells have but such an edge in common. No diagonal
// is an edge: those join cells with a face in common.
class Polygons {
 public:
  Polygons(const PiecePolygons& polygons, std::vector<Eigen::Vector3d> places)
      : polygons_(polygons) {
    mesh_.vertices = std::move(places);
  }

  Mesh mesh() {
    std::vector<Triangle> others;
    const std::vector<std::uint64_t> shared = shared_diagonals();
    for_each([&](const std::uint32_t* corner, std::uint32_t size) {
      if (size == 4 && !is_among(shared, diagonal(corner)))
        add_quad(corner);
      else if (size == 3)
        others.push_back({corner[0], corner[1], corner[2]});
      else
        add_about_middle(corner, size, others);
    });
    mesh_.quads = mesh_.triangles.size() / 2;
    mesh_.triangles.insert(mesh_.triangles.end(), others.begin(), others.end());
    return std::move(mesh_);
  }

  // Of each vertex that was put into a polygon: one of its corners.
  const std::vector<std::uint32_t>& corner_beside() const { return corner_beside_; }

 private:
  template <class Visit>
  void for_each(Visit&& visit) const {
    const std::uint32_t* corner = polygons_.corners.data();
    for (const std::uint32_t size : polygons_.sizes) {
      visit(corner, size);
      corner += size;
    }
  }

  double length(std::uint32_t a, std::uint32_t b) const {
    return (mesh_.vertices[a] - mesh_.vertices[b]).norm();
  }

  // At which corner the shorter diagonal begins, 0 or 1.
  int first_of(const std::uint32_t* c) const {
    return length(c[0], c[2]) <= length(c[1], c[3]) ? 0 : 1;
  }

  static std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }
  std::uint64_t diagonal(const std::uint32_t* c) const {
    return key_of(c[first_of(c)], c[first_of(c) + 2]);
  }
  static bool is_among(const std::vector<std::uint64_t>& sorted, std::uint64_t key) {
    return std::binary_search(sorted.begin(), sorted.end(), key);
  }

  std::vector<std::uint64_t> shared_diagonals() const {
    std::vector<std::uint64_t> all, shared;
    for_each([&](const std::uint32_t* corner, std::uint32_t size) {
      if (size == 4) all.push_back(diagonal(corner));
    });
    std::sort(all.begin(), all.end());
    for (std::size_t i = 1; i < all.size(); ++i)
      if (all[i] == all[i - 1]) shared.push_back(all[i]);
    return shared;
  }

  void add_quad(const std::uint32_t* c) {
    const int first = first_of(c);
    const std::uint32_t last = c[(first + 3) % 4];
    mesh_.triangles.push_back({c[first], c[first + 1], c[first + 2]});
    mesh_.triangles.push_back({c[first], c[first + 2], last});
  }

  void add_about_middle(const std::uint32_t* corner, std::uint32_t size,
                        std::vector<Triangle>& triangles) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::uint32_t k = 0; k < size; ++k) middle += mesh_.vertices[corner[k]] / size;
    const auto vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(middle);
    corner_beside_.push_back(corner[0]);
    for (std::uint32_t k = 0; k < size; ++k)
      triangles.push_back({corner[k], corner[(k + 1) % size], vertex});
  }

  const PiecePolygons& polygons_;
  Mesh mesh_;
  std::vector<std::uint32_t> corner_beside_;
};

SharpReport report_of(const std::vector<Placer::Placed>& placed) {
  SharpReport report;
  for (const Placer::Placed& p : placed) {
    report.moved_vertices += p.pieces_met > 0;
    report.edge_vertices += p.pieces_met > 1;
    report.corners += p.pieces_met > 2;
  }
  return report;
}

std::vector<double> means_of(const std::vector<double>& values, const Members& members) {
  std::vector<double> means;
  for (const auto& list : members) {
    double sum = 0;
    for (const std::uint32_t v : list) sum += values[v];
    means.push_back(sum / static_cast<double>(list.size()));
  }
  return means;
}

}  // namespace

SharpReport make_dual(SurfaceResult& result, std::span<const Eigen::Vector3d> points,
                      const OneSidedFits* sharp) {
  const CellGrid cells{result.cells_from_m, result.finest_cell_m};
  if (!(cells.side_m > 0))
    throw Error(Trouble::usage, "quads: this method's surface is not cut out of cells",
                "choose ssd, mls, rbf or range-fusion");
  SurfacePieces pieces = pieces_in_cells(result.surface, cells);
  const PiecePolygons polygons = polygons_between(result.surface, pieces);
  const Members members = members_of(result.surface, pieces);
  const Placer placer(result.surface, cells, sharp);
  std::vector<Placer::Placed> placed(members.size());
  parallel_for(members.size(), [&](std::size_t i) { placed[i] = placer.place(members[i]); });
  std::vector<Eigen::Vector3d> places;
  places.reserve(placed.size());
  for (const Placer::Placed& p : placed) places.push_back(p.at);
  Polygons dual(polygons, std::move(places));
  const Mesh mesh = dual.mesh();
  std::vector<std::uint32_t> vertex_of;
  result.surface = kept_triangles(mesh, std::vector<char>(mesh.triangles.size(), 1), vertex_of);
  for (std::vector<double>* values : {&result.standard_error_m, &result.vertex_smoothing_m}) {
    if (values->empty()) continue;
    std::vector<double> of_dual = means_of(*values, members);
    for (const std::uint32_t corner : dual.corner_beside()) of_dual.push_back(of_dual[corner]);
    values->clear();
    for (const std::uint32_t v : vertex_of) values->push_back(of_dual[v]);
  }
  result.support_m = distance_to_points(result.surface, points);
  return report_of(placed);
}

QuadWarp quad_warp(const Mesh& mesh) {
  QuadWarp warp;
  for_each_polygon(mesh, [&](std::span<const std::uint32_t> corners) {
    if (corners.size() != 4) return;
    const auto from = [&](int k, int first) -> Eigen::Vector3d {
      return mesh.vertices[corners[k]] - mesh.vertices[corners[first]];
    };
    const Eigen::Vector3d a = from(2, 0), b = from(3, 1), across = a.cross(b);
    if (!(across.norm() > 0)) return;
    const double apart = std::abs(from(1, 0).dot(across.normalized()));
    const double share = 2 * apart / (a.norm() + b.norm());
    warp.rms += share * share;
    warp.largest = std::max(warp.largest, share);
  });
  if (mesh.quads > 0) warp.rms = std::sqrt(warp.rms / static_cast<double>(mesh.quads));
  return warp;
}

}  // namespace scan
