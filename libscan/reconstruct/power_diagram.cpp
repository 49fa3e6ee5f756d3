// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/power_diagram.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Random.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>

namespace scan {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Simple_cartesian<CGAL::Gmpq>;
using Number = std::uint32_t;
using Delaunay = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<
                CGAL::Triangulation_vertex_base_with_info_3<Number, Kernel>,
                CGAL::Triangulation_cell_base_with_info_3<
                    Number, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>>>;
using Regular = CGAL::Regular_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<
                CGAL::Triangulation_vertex_base_with_info_3<
                    Number, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>,
                CGAL::Triangulation_cell_base_with_info_3<
                    Number, Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>>>;

// A centre's equations are solved in doubles if their determinant, by the lengths of the rows, is
// above this: rounding then moves it by 1e-9 of the points' distances at most.
constexpr double safe_determinant = 1e-6;

Eigen::Vector3d circumcentre(const Delaunay::Cell& cell) {
  const auto place = [&](int k) {
    const Delaunay::Point& p = cell.vertex(k)->point();
    return Eigen::Vector3d(p.x(), p.y(), p.z());
  };
  Eigen::Matrix3d rows;
  Eigen::Vector3d right;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = place(k + 1) - place(0);
    const double length = d.norm();
    rows.row(k) = d / length;
    right[k] = length / 2;
  }
  if (std::abs(rows.determinant()) > safe_determinant) return place(0) + rows.inverse() * right;
  const auto exact = [&](int k) { return Exact::Point_3(place(k)[0], place(k)[1], place(k)[2]); };
  const Exact::Point_3 x = CGAL::circumcenter(exact(0), exact(1), exact(2), exact(3));
  return {CGAL::to_double(x.x()), CGAL::to_double(x.y()), CGAL::to_double(x.z())};
}

template <class Triangulation>
struct NumberedCell {
  std::array<Number, 4> corners;  // ascending
  typename Triangulation::Cell_handle cell;
};

// The finite cells by the numbers of their corners; each cell gets its place in the list.
template <class Triangulation>
std::vector<NumberedCell<Triangulation>> numbered_cells(const Triangulation& triangulation) {
  std::vector<NumberedCell<Triangulation>> cells;
  for (const auto cell : triangulation.finite_cell_handles()) {
    std::array<Number, 4> corners;
    for (int k = 0; k < 4; ++k) corners[k] = cell->vertex(k)->info();
    std::sort(corners.begin(), corners.end());
    cells.push_back({corners, cell});
  }
  std::sort(cells.begin(), cells.end(),
            [](const auto& a, const auto& b) { return a.corners < b.corners; });
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].cell->info() = static_cast<Number>(i);
  return cells;
}

// Of a cell's edges, by which of its corners they join.
std::uint8_t edge_bit(int one, int other) {
  constexpr std::array<std::array<int, 4>, 4> place{
      {{0, 0, 1, 2}, {0, 0, 3, 4}, {1, 3, 0, 5}, {2, 4, 5, 0}}};
  return static_cast<std::uint8_t>(1 << place[one][other]);
}

// Adds the face of the edge between two corners of a cell and notes it in all cells around.
void add_face(const Regular& triangulation, const Regular::Cell_handle cell, int one, int other,
              std::vector<std::uint8_t>& seen, PowerDiagram& diagram) {
  if (seen[cell->info()] & edge_bit(one, other)) return;
  if (cell->vertex(one)->info() > cell->vertex(other)->info()) std::swap(one, other);
  const Regular::Vertex_handle first = cell->vertex(one), second = cell->vertex(other);
  auto& loops = diagram.corners_of_faces;
  const std::size_t begin = loops.size();
  bool is_bounded = true;
  Regular::Cell_circulator around = triangulation.incident_cells(cell, one, other, cell);
  const Regular::Cell_circulator end = around;
  do {
    if (triangulation.is_infinite(around)) {
      is_bounded = false;
      continue;
    }
    seen[around->info()] |= edge_bit(around->index(first), around->index(second));
    loops.push_back(around->info());
  } while (++around != end);
  if (!is_bounded) loops.resize(begin);
  const auto loop = loops.begin() + static_cast<std::ptrdiff_t>(begin);
  std::rotate(loop, std::min_element(loop, loops.end()), loops.end());
  diagram.faces.push_back({first->info(), second->info(), begin, loops.size()});
}

}  // namespace

VoronoiCells voronoi_cells(std::span<const Eigen::Vector3d> points) {
  CGAL::get_default_random() = CGAL::Random(1);  // else each call starts where the last one ended
  std::vector<std::pair<Delaunay::Point, Number>> input;
  for (const auto& x : points)
    input.push_back({{x[0], x[1], x[2]}, static_cast<Number>(input.size())});
  Delaunay triangulation(input.begin(), input.end());
  VoronoiCells cells;
  cells.of_point.resize(points.size());
  if (triangulation.dimension() < 3) return cells;
  for (const auto& [corners, cell] : numbered_cells(triangulation)) {
    cells.corners.push_back(circumcentre(*cell));
    for (const Number point : corners) cells.of_point[point].push_back(cell->info());
  }
  return cells;
}

PowerDiagram power_diagram(std::span<const Ball> balls) {
  CGAL::get_default_random() = CGAL::Random(1);
  std::vector<std::pair<Regular::Weighted_point, Number>> input;
  for (const Ball& b : balls)
    input.push_back({{{b.centre[0], b.centre[1], b.centre[2]}, b.radius * b.radius},
                     static_cast<Number>(input.size())});
  Regular triangulation(input.begin(), input.end());
  PowerDiagram diagram;
  diagram.is_unbounded.assign(balls.size(), 0);
  if (triangulation.dimension() < 3) return diagram;
  for (const auto& cell : numbered_cells(triangulation)) diagram.corners.push_back(cell.corners);
  std::vector<std::uint8_t> seen(diagram.corners.size(), 0);
  for (const auto cell : triangulation.finite_cell_handles())  // neighbours follow, for the cache
    for (int one = 0; one < 3; ++one)
      for (int other = one + 1; other < 4; ++other)
        add_face(triangulation, cell, one, other, seen, diagram);
  std::sort(diagram.faces.begin(), diagram.faces.end(), [](const PowerFace& a, const PowerFace& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  std::vector<Regular::Vertex_handle> of_hull;
  triangulation.finite_adjacent_vertices(triangulation.infinite_vertex(),
                                         std::back_inserter(of_hull));
  for (const auto vertex : of_hull) diagram.is_unbounded[vertex->info()] = 1;
  return diagram;
}

}  // namespace scan
