// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// PCL's cloud format.
#pragma once

#include <filesystem>

#include "libscan/core/point_cloud.h"

namespace scan {

// x y z, normal_x normal_y normal_z and intensity where they are there, in whatever number type the
// file has; ascii, binary and binary_compressed. Points that are not finite are kept (read_scan
// drops and counts them). scan::Error (input) names file, header line or field.
PointCloud read_pcd(const std::filesystem::path& path);

// Binary, doubles: coordinates come back to the bit. Sigma and covariances are left out.
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace scan
