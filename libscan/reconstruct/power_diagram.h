// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Voronoi cells of points and of balls, by CGAL's triangulations (GPL): part of the target
// libscan::cgal. What comes is in an order of its own, whatever CGAL's is.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scan {

struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

struct VoronoiCells {
  std::vector<Eigen::Vector3d> corners;
  // Ascending; without those at infinity; none: the point is another's twin.
  std::vector<std::vector<std::uint32_t>> of_point;
};

// The points must not lie in one plane, or there are no corners.
VoronoiCells voronoi_cells(std::span<const Eigen::Vector3d> points);

// Where the cells of two balls meet: a convex polygon in the plane of equal power.
struct PowerFace {
  std::uint32_t first = 0, second = 0;  // balls, first < second
  std::size_t begin = 0, end = 0;       // of its corners in corners_of_faces; none: unbounded
};

// The cell of a ball: where |x - centre|^2 - radius^2 is least. Each corner belongs to four cells,
// also where more than four meet at one place: so the faces between two sets of cells make a closed
// manifold where they are bounded.
struct PowerDiagram {
  std::vector<std::array<std::uint32_t, 4>>
      corners;                   // ascending balls, which have equal power there
  std::vector<PowerFace> faces;  // by first and second
  // Of each face from its lowest on, counter-clockwise as its second ball sees them; places may
  // coincide.
  std::vector<std::uint32_t> corners_of_faces;
  std::vector<char> is_unbounded;  // by ball

  std::span<const std::uint32_t> corners_of(const PowerFace& face) const {
    return std::span(corners_of_faces).subspan(face.begin, face.end - face.begin);
  }
};

PowerDiagram power_diagram(std::span<const Ball> balls);

}  // namespace scan
