// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Points of a mesh as scanners about it see them.
#pragma once

#include <filesystem>

#include "libscan/core/mesh.h"

namespace scan {

struct ViewOptions {
  std::size_t points = 100'000;  // of all views together
  int views = 10;
  double sigma_m = 0;         // along the ray at normal incidence; grows with 1 / cosine
  double displacement_m = 0;  // of each view, in a random direction
  double turn_rad = 0;        // of each view, about the object's centre
};

struct Views {
  PointCloud cloud;                         // world; normals face the scanner; sigma_m as it is
  std::vector<Eigen::Vector3d> viewpoints;  // of each point's scanner
};

// Scanners at two diagonals from the centre, spread evenly over all directions. What they see is
// uniform by area on the parts that face them at less than 78 degrees and that nothing hides.
Views views_of(const Mesh& mesh, const ViewOptions& options);

// Stanford's ten scans of the bunny in their published poses.
Views stanford_views(const std::filesystem::path& data);

}  // namespace scan
