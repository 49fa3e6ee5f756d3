// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Oriented points made ready for a fit in the unit cube.
#pragma once

#include <cstddef>
#include <vector>

#include "libscan/core/point_cloud.h"
#include "libscan/reconstruct/octree_grid.h"

namespace scan {

struct Samples {
  UnitBox box;
  std::vector<Eigen::Vector3d> points;   // in the unit cube, in lexicographic order, no two equal
  std::vector<Eigen::Vector3d> normals;  // unit
  std::vector<double> area;              // of the surface around each, unit cube; robust
  std::size_t invalid_points = 0;        // not finite, no normal, or equal with opposed normals
  std::size_t outlying_points = 0;       // outside the robust box
};

// Points at one place are merged, their normals averaged. The area is pi r^2 / k to the k-th
// neighbour (k = 10), then the median over these neighbours, so that a stray point has no more
// weight than the points it strayed from. Throws scan::Error (input) for fewer than 16 valid points
// at different places or a cloud without extent.
Samples prepare_samples(const PointCloud& cloud);

// Depth of each sample: the deepest whose cells hold `samples_per_cell` samples where the surface
// passes, within the limits.
std::vector<int> sample_depths(const Samples& samples, double samples_per_cell, int least,
                               int most);

}  // namespace scan
