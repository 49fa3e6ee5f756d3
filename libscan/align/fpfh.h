// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Fast point feature histograms (Rusu, Blodow and Beetz 2009): how the normals around a point stand
// to each other, in three histograms that no rigid motion changes.
#pragma once

#include <array>
#include <vector>

#include "libscan/core/point_cloud.h"
#include "libscan/search/kd_tree.h"

namespace scan {

inline constexpr std::size_t fpfh_bins = 11;  // of each of the three angles
using Fpfh = std::array<float, 3 * fpfh_bins>;

// The angles of two points with unit normals (Rusu 2009, eq. 1): theta = atan2(w . n2, n1 . n2) in
// (-pi, pi], alpha = v . n2 and phi = u . d in [-1, 1], in the frame u = n1, v = d x u, w = u x v
// of the point whose normal is nearer to the line that joins them, so that their order does not
// matter. Empty where the frame is not defined: points that coincide, or a normal along the line.
struct PairAngles {
  double theta_rad = 0, alpha = 0, phi = 0;
};
bool pair_angles(const Eigen::Vector3d& point_1, const Eigen::Vector3d& normal_1,
                 const Eigen::Vector3d& point_2, const Eigen::Vector3d& normal_2,
                 PairAngles& angles);

// One per point of the cloud, whose points `search` holds, from neighbours within the radius: each
// histogram sums to 100, or is zero for a point without neighbours. Points with a zero normal have
// none and count for none.
std::vector<Fpfh> fpfh(const PointCloud& cloud, const KdTree& search, double radius_m);

}  // namespace scan
