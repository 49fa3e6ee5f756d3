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
  std::vector<double> sigma;             // along the normal, unit cube: given or estimated
  bool scattered_all_around = false;     // not only along the rays that the points came by
  std::size_t invalid_points = 0;        // not finite, no normal, or equal with opposed normals
  std::size_t outlying_points = 0;       // outside the robust box
};

// Points at one place are merged, their normals averaged. The area is pi r^2 / k to the k-th
// neighbour (k = 10), then the median over these neighbours, so that a stray point has no more
// weight than the points it strayed from; neighbours are looked for among every m-th point, m such
// that they lie several sigma away, since scatter moves near points apart. Sigma is the points' own
// if they have it (a scanner's, along its rays), else `sigma_m`, or if that is 0, what
// estimate_noise() finds, in all directions. Throws scan::Error (input) for fewer than 16 valid
// points at different places or a cloud without extent.
Samples prepare_samples(const PointCloud& cloud, double sigma_m = 0);

// Depth of each sample: the deepest whose cells are not narrower than one spacing and 1.5 sigma,
// within the limits; areas below those of a twentieth of the samples do not count.
std::vector<int> sample_depths(const Samples& samples, int least, int most);

}  // namespace scan
