// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Thinning of point clouds.
#pragma once

#include "libscan/core/point_cloud.h"

namespace scan {

// One point per occupied cube of side `side_m`: the mean of its points; normals are averaged and
// renormalised, sigma_m is averaged, intensity too, covariances are averaged. Cubes are aligned
// with the cloud's own minimum, keys have 64 bits per axis, the order is that of the first point of
// each cube. Throws scan::Error (usage) if side_m is not positive.
PointCloud voxel_grid(const PointCloud& cloud, double side_m);

}  // namespace scan
