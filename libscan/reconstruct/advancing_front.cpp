// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/advancing_front.h"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <utility>

#include "libscan/reconstruct/numbered.h"

namespace scan {
namespace {

using FrontKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// An edge of the front as the set of them orders it: CGAL's own is a value and an address, which
// decides between equal values. Here points decide, by their indices: the edge's two, then the
// third of the triangle behind it, whose edge is in the front once.
template <class Facets>  // the one behind an edge and the one that comes next
struct FrontEdge {
  double first;
  Facets* second;
  std::array<std::size_t, 3> points;

  FrontEdge(double value, Facets* facets) : first(value), second(facets) {
    const auto& [edge, opposite] = facets->first;
    const auto& [cell, begin, end] = edge;
    points = {cell->vertex(begin)->id(), cell->vertex(end)->id(),
              cell->vertex(6 - opposite - begin - end)->id()};
    if (points[0] > points[1]) std::swap(points[0], points[1]);
  }
  bool operator<(const FrontEdge& other) const {
    return std::tie(first, points) < std::tie(other.first, other.points);
  }
};

template <class Base>
class FrontVertex : public Base {
 public:
  template <class Tds>
  struct Rebind_TDS {
    using Other = FrontVertex<typename Base::template Rebind_TDS<Tds>::Other>;
  };
  using Radius_ptr_type = FrontEdge<typename Base::IO_edge_type>;
  using Base::Base;
};

using FrontElements = CGAL::Triangulation_data_structure_3<
    FrontVertex<Numbered<CGAL::Advancing_front_surface_reconstruction_vertex_base_3<FrontKernel>>>,
    Numbered<CGAL::Advancing_front_surface_reconstruction_cell_base_3<FrontKernel>>>;

// Shows the front only those facets that it looks for: with three free corners to begin at, and the
// selected ones at the end. To compare by number the cells of all took a third of the time of a
// front in many pieces.
class FrontTriangulation : public CGAL::Delaunay_triangulation_3<FrontKernel, FrontElements> {
 public:
  using Delaunay_triangulation_3::Delaunay_triangulation_3;

  class Finite_facets_iterator {
   public:
    Finite_facets_iterator(const FrontTriangulation& all, All_cells_iterator cell)
        : all_(&all), facet_(cell, 0), cell_(cell), end_(all.all_cells_end()) {
      skip();
    }
    const Facet& operator*() const { return facet_; }
    Finite_facets_iterator& operator++() {
      advance();
      skip();
      return *this;
    }
    void operator++(int) { ++*this; }
    bool operator==(const Finite_facets_iterator& other) const { return facet_ == other.facet_; }

   private:
    void advance() {
      if (++facet_.second < 4) return;
      facet_ = Facet(++cell_, 0);
    }
    void skip() {
      while (cell_ != end_ && !all_->is_shown(facet_)) advance();
    }

    const FrontTriangulation* all_;
    Facet facet_;
    All_cells_iterator cell_, end_;
  };

  Finite_facets_iterator finite_facets_begin() const { return {*this, all_cells_begin()}; }
  Finite_facets_iterator finite_facets_end() const { return {*this, all_cells_end()}; }

 private:
  bool is_shown(const Facet& facet) const {
    const auto& [cell, corner] = facet;
    const bool is_selected = cell->is_selected_facet(corner);
    bool is_free = true;
    for (int k = 1; k < 4 && (is_free || is_selected); ++k) {
      const Vertex_handle vertex = cell->vertex((corner + k) & 3);
      if (is_infinite(vertex)) return false;
      is_free = is_free && vertex->is_exterior();
    }
    if (!is_free && !is_selected) return false;
    const Cell_handle other = cell->neighbor(corner);
    const bool is_first = cell < other;
    return is_free ? is_first : is_first || !other->is_selected_facet(other->index(cell));
  }
};

}  // namespace

Mesh advancing_front(std::span<const Eigen::Vector3d> points) {
  std::vector<std::pair<FrontKernel::Point_3, std::size_t>> input;
  for (const auto& x : points) input.push_back({{x[0], x[1], x[2]}, input.size()});
  FrontTriangulation triangulation(input.begin(), input.end());
  CGAL::Advancing_front_surface_reconstruction<FrontTriangulation> front(triangulation);
  front.run();
  std::vector<std::array<std::size_t, 3>> faces;
  CGAL::write_triple_indices(std::back_inserter(faces), front);
  Mesh mesh;
  mesh.vertices.assign(points.begin(), points.end());
  for (const auto& face : faces)
    mesh.triangles.push_back({static_cast<std::uint32_t>(face[0]),
                              static_cast<std::uint32_t>(face[1]),
                              static_cast<std::uint32_t>(face[2])});
  return mesh;
}

}  // namespace scan
