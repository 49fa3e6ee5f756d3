// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The nearest point of a triangle mesh, exact in double precision.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "libscan/core/mesh.h"

namespace scan {

struct ClosestPoint {
  Eigen::Vector3d point;
  std::uint32_t triangle = 0;
  double distance_m = 0;
};

// Nearest point of one triangle: the foot of the perpendicular (barycentric, Ericson 2005, section
// 3.4) or on an edge (section 5.1.2). Its distance is right to a few roundings of the triangle's
// size and its distance from x, however thin the triangle; degenerate triangles are segments or
// points.
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b, const Eigen::Vector3d& c);

inline constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

// A bounding-volume tree over a mesh's triangles.
class MeshSearch {
 public:
  // Throws scan::Error (input) for a mesh without triangles.
  explicit MeshSearch(const Mesh& mesh);
  ~MeshSearch();
  MeshSearch(MeshSearch&&) noexcept;
  MeshSearch& operator=(MeshSearch&&) noexcept;

  // Nearest point; the lowest triangle among equally near ones. `guess`: a triangle that may be the
  // nearest, as that of a query nearby; it makes the search quicker and never changes the answer.
  ClosestPoint closest(const Eigen::Vector3d& query, std::uint32_t guess = no_triangle) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

// closest() of each query, on all threads and along a curve that fills space, so that each query's
// guess is the answer of the one before. Queries that are not finite get triangle no_triangle and
// an infinite distance.
std::vector<ClosestPoint> closest_of_each(const MeshSearch& search,
                                          std::span<const Eigen::Vector3d> queries);

}  // namespace scan
