// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A scan made ready to be aligned, once for many pairs.
#pragma once

#include <utility>
#include <vector>

#include "libscan/align/local_surface.h"
#include "libscan/core/point_cloud.h"
#include "libscan/core/pose.h"
#include "libscan/search/search.h"

namespace scan {

struct PrepareOptions {
  double thin_m = 0;    // side of the voxels that leave one point each; 0: every point
  int neighbours = 16;  // that fix a point's plane
  SearchMethod search = SearchMethod::kd_tree;
};

// Throws scan::Error (usage) naming the option and its limit.
void check(const PrepareOptions& options);

// The finite points of a cloud relative to their mean, so that far coordinates cost no digits.
struct PreparedCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // in the cloud's frame, metres
  // Relative to the origin, metres, along a curve that fills space (curve_order).
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> index;      // of each in the cloud, or among the voxels
  std::vector<Eigen::Vector3d> normals;  // unit; (0,0,0): no plane there
  bool oriented = false;         // the normals came with the cloud, so their signs mean something
  bool normals_refused = false;  // they came, but are not those of the points: replaced, signs kept
  std::vector<LocalFit> fits;    // to the points' neighbours
  double spacing_m = 0;          // median distance to the nearest other point
  std::vector<Eigen::Matrix3d> covariances;  // of the points, m^2, as the scan tells them; or empty
  double radius_m = 0;                       // root mean square distance from the origin
  std::size_t invalid_points = 0;            // not finite, left out
  AnySearch search = make_search(SearchMethod::kd_tree, {});  // over the points

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }
};

PreparedCloud prepare(const PointCloud& cloud, const PrepareOptions& options = {});

// Both at once.
std::pair<PreparedCloud, PreparedCloud> prepare_pair(const PointCloud& source,
                                                     const PointCloud& target,
                                                     const PrepareOptions& options = {});

// The pose with the nearest rotation in place of its matrix; a rotation to rounding keeps its bits.
Pose with_proper_rotation(const Pose& pose);

// A pose between the clouds' own frames as one between their prepared points, and back.
Pose local_pose(const Pose& target_from_source, const PreparedCloud& source,
                const PreparedCloud& target);
Pose global_pose(const Pose& local, const PreparedCloud& source, const PreparedCloud& target);

}  // namespace scan
