// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What a scan shows of its surface wherever it stands: thinned points, and for each a descriptor
// that no rigid motion changes. Made once per scan, however many pairs it takes part in.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "libscan/core/point_cloud.h"

namespace scan {

// The side of the cubes that leaves the clouds some thousand points each: one for all of them,
// since descriptors compare only at equal scale. The lower median over the clouds, so that a few
// large or small ones do not decide. 0 if no cloud has two distinct points.
double feature_side_m(std::span<const PointCloud> clouds);

struct ScanFeatures {
  PointCloud cloud;                          // finite points with normals, thinned
  std::vector<float> descriptors;            // `dimensions` numbers per point, one after another
  double side_m = 0;                         // of the cubes
  std::optional<Eigen::Vector3d> viewpoint;  // where the scanner stood, in the cloud's frame

  static constexpr std::size_t dimensions = 66;
};

// `cloud` in its own frame with normals that face the scanner: their sign decides whether
// descriptors of two scans compare. `viewpoint`: empty if unknown; then no check that one scan's
// points are not seen through the other's. Throws scan::Error: input for a cloud without normals,
// usage for a side that is not positive.
ScanFeatures describe(const PointCloud& cloud, double side_m,
                      const std::optional<Eigen::Vector3d>& viewpoint = {});

}  // namespace scan
