// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What only verify knows: the true surface, the true poses, and where each ray really ended.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "libscan/core/mesh.h"
#include "libscan/core/shape.h"

namespace scan {

// The union of analytic solids and closed or open meshes, in world coordinates (metres).
struct TrueSurface {
  std::vector<PlacedShape> shapes;
  std::vector<Mesh> meshes;
};

// Of all parts; infinite with a plane.
Bounds bounds_of(const TrueSurface& surface);

// Where a ray's centre first meets the scene; `object` is -1 (and point NaN) for a ray into
// nothing.
struct RayTruth {
  Eigen::Vector3d point_in_scanner =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d normal_in_scanner = Eigen::Vector3d::Zero();
  int object = -1;
};

struct ScanTruth {
  std::string name;
  Pose world_from_scanner = Pose::Identity();
  std::vector<RayTruth> rays;  // indexed like Scan::ray
};

struct Truth {
  TrueSurface surface;
  std::vector<ScanTruth> scans;
};

}  // namespace scan
