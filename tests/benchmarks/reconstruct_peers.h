// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Other programs' reconstruction, with their default settings, one unit each.
#pragma once

#include "libscan/core/mesh.h"

namespace scan {

// PCL's Poisson at depth 8.
Mesh pcl_poisson(const PointCloud& cloud);

// Open3D's Poisson at depth 9; only where LIBSCAN_WITH_OPEN3D is defined.
Mesh open3d_poisson(const PointCloud& cloud);

}  // namespace scan
